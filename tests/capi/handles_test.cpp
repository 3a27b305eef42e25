// Handles that are NULL, of another type, or none at all: every function, every handle argument.
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "world.hpp"

namespace brainshift::test {
namespace {

struct Probe {
  const char* function;
  const char* type;                       // of the handle that is replaced
  std::function<brs_status(void*)> call;  // all other arguments are good
};

template <class T>
T* as(void* handle) {
  return static_cast<T*>(handle);
}

// Results that the probes write to, if a call goes through against all expectation.
struct Scratch {
  brs_scene* scene = nullptr;
  brs_stepper* stepper = nullptr;
  brs_mesh* mesh = nullptr;
  brs_surface* surface = nullptr;
  brs_snapshot* snapshot = nullptr;
  const std::int32_t* triangles = nullptr;
  const double* view = nullptr;
  std::int64_t count = 0;
  double values[3] = {0.0, 0.0, 0.0};
};

std::vector<Probe> probes_of_values(World& w, Scratch& s) {
  const auto& b = w.block;
  const auto& v = w.wall;
  return {
      {"brs_context_set_progress", "context",
       [](void* h) { return brs_context_set_progress(as<brs_context>(h), nullptr, nullptr); }},
      {"brs_context_set_cancel", "context",
       [](void* h) { return brs_context_set_cancel(as<brs_context>(h), 0); }},
      {"brs_mesh_create", "context",
       [&](void* h) {
         return brs_mesh_create(as<brs_context>(h), b.points.data(), b.points.rows(), b.tets.data(),
                                b.tets.rows(), nullptr, 0, &s.mesh);
       }},
      {"brs_mesh_surface", "mesh",
       [&](void* h) { return brs_mesh_surface(as<brs_mesh>(h), &s.triangles, &s.count); }},
      {"brs_mesh_faces", "mesh",
       [&](void* h) {
         return brs_mesh_faces(as<brs_mesh>(h), 0, nullptr, 0, nullptr, 0, &s.count);
       }},
      {"brs_surface_create", "context",
       [&](void* h) {
         return brs_surface_create(as<brs_context>(h), BRS_SURFACE_CAVITY, v.points.data(),
                                   v.points.rows(), v.triangles.data(), v.triangles.rows(), nullptr,
                                   &s.surface);
       }},
      {"brs_surface_distance", "surface",
       [&](void* h) { return brs_surface_distance(as<brs_surface>(h), s.values, 1, s.values); }},
      {"brs_scene_create", "context",
       [&](void* h) { return brs_scene_create(as<brs_context>(h), w.mesh, &s.scene); }},
      {"brs_scene_create", "mesh",
       [&](void* h) {
         brs_scene_destroy(s.scene);  // that of the probe before
         return brs_scene_create(w.context, as<brs_mesh>(h), &s.scene);
       }},
  };
}

std::vector<Probe> probes_of_scene(World& w) {
  const auto scene = [](const char* name, std::function<brs_status(brs_scene*)> call) {
    return Probe{name, "scene", [call](void* h) { return call(as<brs_scene>(h)); }};
  };
  static const double down[3] = {0.0, 0.0, -1.0};
  static const std::int32_t node = 0, other = 1;
  return {
      scene("brs_scene_set_material",
            [](brs_scene* h) {
              const brs_material m = tissue();
              return brs_scene_set_material(h, 0, &m);
            }),
      scene("brs_scene_set_gravity", [](brs_scene* h) { return brs_scene_set_gravity(h, down); }),
      scene("brs_scene_set_balanced_reference",
            [](brs_scene* h) { return brs_scene_set_balanced_reference(h, 1); }),
      scene("brs_scene_set_csf", [](brs_scene* h) { return brs_scene_set_csf(h, 1e-6, 0, NAN); }),
      scene("brs_scene_add_compartment",
            [&w](brs_scene* h) {
              brs_compartment box = w.compartment();
              box.name = "another";
              return brs_scene_add_compartment(h, &box, nullptr);
            }),
      scene("brs_scene_add_fixed",
            [](brs_scene* h) { return brs_scene_add_fixed(h, "x", &node, 1, BRS_AXES, nullptr); }),
      scene("brs_scene_add_tied",
            [](brs_scene* h) { return brs_scene_add_tied(h, "x", &node, &other, 1, nullptr); }),
      scene("brs_scene_add_support",
            [](brs_scene* h) {
              const double k = 1.0;
              return brs_scene_add_support(h, "x", &node, 1, &k, 1, nullptr);
            }),
      scene("brs_scene_add_obstacle",
            [&w](brs_scene* h) {
              return brs_scene_add_obstacle(h, "x", &node, 1, w.surface, 1, nullptr, 0, nullptr);
            }),
      {"brs_scene_add_obstacle", "surface",
       [&w](void* h) {
         return brs_scene_add_obstacle(w.scene, "x", &node, 1, as<brs_surface>(h), 1, nullptr, 0,
                                       nullptr);
       }},
      scene("brs_scene_add_opposing",
            [](brs_scene* h) {
              return brs_scene_add_opposing(h, "x", &node, &other, down, 1, nullptr);
            }),
  };
}

std::vector<Probe> probes_of_stepper(World& w, Scratch& s) {
  const auto stepper = [](const char* name, std::function<brs_status(brs_stepper*)> call) {
    return Probe{name, "stepper", [call](void* h) { return call(as<brs_stepper>(h)); }};
  };
  return {
      {"brs_stepper_create", "scene",
       [&](void* h) { return brs_stepper_create(as<brs_scene>(h), nullptr, &s.stepper); }},
      stepper("brs_stepper_set_gravity",
              [&](brs_stepper* h) { return brs_stepper_set_gravity(h, s.values); }),
      stepper("brs_stepper_set_enabled",
              [&](brs_stepper* h) { return brs_stepper_set_enabled(h, w.contact, 1); }),
      stepper("brs_stepper_set_csf",
              [](brs_stepper* h) { return brs_stepper_set_csf(h, 0, BRS_CSF_FULL, 0.0); }),
      stepper("brs_stepper_solve_static",
              [](brs_stepper* h) { return brs_stepper_solve_static(h, nullptr); }),
      stepper("brs_stepper_field",
              [&](brs_stepper* h) { return brs_stepper_field(h, 0, &s.view, nullptr, nullptr); }),
      stepper("brs_stepper_displacement_at",
              [&](brs_stepper* h) {
                return brs_stepper_displacement_at(h, s.values, 1, s.values, nullptr);
              }),
      stepper("brs_stepper_rest_points_of",
              [&](brs_stepper* h) {
                return brs_stepper_rest_points_of(h, s.values, 1, s.values, nullptr);
              }),
      stepper("brs_stepper_compartment",
              [](brs_stepper* h) {
                brs_compartment_state state;
                brs_compartment_state_init(&state, sizeof state);
                return brs_stepper_compartment(h, 0, &state);
              }),
      stepper("brs_stepper_contact",
              [&](brs_stepper* h) {
                brs_contact_state state;
                brs_contact_state_init(&state, sizeof state);
                return brs_stepper_contact(h, w.contact, &state);
              }),
      stepper("brs_stepper_snapshot",
              [&](brs_stepper* h) { return brs_stepper_snapshot(h, &s.snapshot); }),
      stepper("brs_stepper_restore",
              [&](brs_stepper* h) { return brs_stepper_restore(h, w.snapshot); }),
      {"brs_stepper_restore", "snapshot",
       [&](void* h) { return brs_stepper_restore(w.stepper, as<brs_snapshot>(h)); }},
  };
}

// Separately: NULL is good to destroy.
std::vector<Probe> probes_of_destroy() {
  return {
      {"brs_context_destroy", "context",
       [](void* h) { return brs_context_destroy(as<brs_context>(h)); }},
      {"brs_mesh_destroy", "mesh", [](void* h) { return brs_mesh_destroy(as<brs_mesh>(h)); }},
      {"brs_surface_destroy", "surface",
       [](void* h) { return brs_surface_destroy(as<brs_surface>(h)); }},
      {"brs_scene_destroy", "scene", [](void* h) { return brs_scene_destroy(as<brs_scene>(h)); }},
      {"brs_stepper_destroy", "stepper",
       [](void* h) { return brs_stepper_destroy(as<brs_stepper>(h)); }},
      {"brs_snapshot_destroy", "snapshot",
       [](void* h) { return brs_snapshot_destroy(as<brs_snapshot>(h)); }},
  };
}

class Handles : public testing::Test {
 protected:
  World w;
  Scratch s;
  std::map<std::string, void*> handles{{"context", w.context}, {"mesh", w.mesh},
                                       {"surface", w.surface}, {"scene", w.scene},
                                       {"stepper", w.stepper}, {"snapshot", w.snapshot}};

  std::vector<Probe> all() {
    std::vector<Probe> probes = probes_of_values(w, s);
    // Steppers first: what the others add to the scene makes no sense together.
    for (auto& more : {probes_of_stepper(w, s), probes_of_scene(w)})
      probes.insert(probes.end(), more.begin(), more.end());
    return probes;
  }
};

TEST_F(Handles, NullIsRefusedByEveryFunctionAndFineToDestroy) {
  for (const Probe& p : all()) EXPECT_EQ(p.call(nullptr), BRS_ERROR_NULL) << p.function;
  for (const Probe& p : probes_of_destroy()) EXPECT_EQ(p.call(nullptr), BRS_OK) << p.function;
  EXPECT_STREQ(brs_context_message(nullptr), "the context is NULL");
}

TEST_F(Handles, OfAnotherTypeAreRefusedByEveryFunctionWithAMessage) {
  std::vector<Probe> probes = all();
  for (const Probe& p : probes_of_destroy()) probes.push_back(p);
  for (const Probe& p : probes) {
    for (const auto& [type, handle] : handles) {
      if (type == p.type) continue;
      EXPECT_EQ(p.call(handle), BRS_ERROR_HANDLE) << p.function << " of a " << type;
      if (std::string(p.function) == "brs_context_set_cancel") continue;  // never touches messages
      EXPECT_EQ(w.message(), "a " + type + " is given where a " + p.type + " is expected")
          << p.function;
    }
  }
}

TEST_F(Handles, ThatAreNoHandlesAreRefusedByEveryFunction) {
  alignas(16) unsigned char zeros[256] = {};
  std::vector<Probe> probes = all();
  for (const Probe& p : probes_of_destroy()) probes.push_back(p);
  for (const Probe& p : probes) EXPECT_EQ(p.call(zeros), BRS_ERROR_HANDLE) << p.function;
}

TEST_F(Handles, OfTheRightTypeAreTakenByEveryProbe) {
  // Otherwise the tests above could pass for another reason.
  for (const Probe& p : all()) EXPECT_EQ(p.call(handles.at(p.type)), BRS_OK) << p.function;
  brs_scene_destroy(s.scene);
  brs_stepper_destroy(s.stepper);
  brs_mesh_destroy(s.mesh);
  brs_surface_destroy(s.surface);
  brs_snapshot_destroy(s.snapshot);
}

TEST_F(Handles, EveryFunctionOfTheHeaderIsProbed) {
  std::ifstream file(BRAINSHIFT_C_HEADER);
  std::stringstream header;
  header << file.rdbuf();
  const std::string text = header.str();
  std::set<std::string> declared, probed{"brs_context_create", "brs_context_message"};
  const std::regex function("BRS_API[^;(]*(brs_[a-z_]+)\\(([^;]*)\\);");
  for (std::sregex_iterator i(text.begin(), text.end(), function), end; i != end; ++i) {
    const std::string name = (*i)[1], arguments = (*i)[2];
    const bool has_handle = std::regex_search(
        arguments, std::regex("brs_(context|mesh|surface|scene|stepper|snapshot)\\*"));
    if (has_handle) declared.insert(name);
  }
  for (const Probe& p : all()) probed.insert(p.function);
  for (const Probe& p : probes_of_destroy()) probed.insert(p.function);
  EXPECT_GT(declared.size(), 30u);
  EXPECT_EQ(declared, probed);
}

}  // namespace
}  // namespace brainshift::test
