// A stream of calls of the C face: handles of any type where one is wanted, or none, numbers of any kind. A
// call returns a status of the list, says something where it is not OK, and leaves the rest usable.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <vector>

#include "brainshift/c/brainshift.h"
#include "robustness/fuzz/numbers.hpp"
#include "robustness/fuzz/targets.hpp"
#include "support/shapes.hpp"

namespace brainshift::test {
namespace {

constexpr std::size_t most_handles = 24;
constexpr int most_calls = 40;

class Calls {
 public:
  Calls(const std::uint8_t* data, std::size_t size) : m_in(data, size) {
    if (brs_context_create(BRS_VERSION, &m_context) != BRS_OK) std::abort();
  }
  ~Calls() {
    while (!m_handles.empty()) destroy(m_handles.size() - 1);
    brs_context_destroy(m_context);
  }
  Calls(const Calls&) = delete;
  Calls& operator=(const Calls&) = delete;

  void run() {
    if (m_in.byte() % 4) furnish();
    for (int i = 0; i < most_calls && m_in.more(); ++i) {
      call(m_in.byte() % 52);
      if (m_handles.size() > most_handles) destroy(0);
    }
  }

 private:
  using Destroy = brs_status (*)(void*);
  struct Handle {
    void* pointer;
    Destroy destroy;
  };

  void destroy(std::size_t i) {
    if (m_handles[i].destroy(m_handles[i].pointer) != BRS_OK) std::abort();
    m_handles.erase(m_handles.begin() + std::ptrdiff_t(i));
  }

  // One of the handles there are, of whatever type; the newest for most, the context or none for some.
  template <class T>
  T* any() {
    const std::uint8_t pick = m_in.byte();
    if (pick == 255) return nullptr;
    if (pick == 254 || m_handles.empty()) return reinterpret_cast<T*>(m_context);
    const std::size_t back = pick < 128 ? 0 : pick % m_handles.size();
    for (std::size_t i = m_handles.size() - back; pick < 250 && i-- > 0;) {   // the next of the type wanted
      if (m_handles[i].destroy == destroy_of<T>()) return static_cast<T*>(m_handles[i].pointer);
    }
    return static_cast<T*>(m_handles[m_handles.size() - 1 - back].pointer);
  }

  template <class T>
  static Destroy destroy_of();

  template <class T>
  void keep(T* handle) {
    if (handle) m_handles.push_back({handle, destroy_of<T>()});
  }

  void expect(brs_status status) {
    const char* name = brs_status_name(status);
    const char* message = brs_context_message(m_context);
    const bool silent = status < 0 && status != BRS_ERROR_NULL && status != BRS_ERROR_HANDLE && message[0] == '\0';
    if (std::strcmp(name, "unknown status") != 0 && status != BRS_ERROR_INTERNAL && !silent) return;
    std::fprintf(stderr, "%s: %s\n", name, message);
    std::abort();
  }

  std::int64_t count(std::size_t there) {   // most are right
    const std::uint8_t b = m_in.byte();
    if (b < 224) return std::int64_t(there);
    if (b < 250) return std::int64_t(b % (there + 1));
    constexpr std::int64_t odd[] = {-1, INT64_MIN, std::int64_t(1) << 31, INT64_MAX};
    return odd[b % 4];
  }
  std::int32_t small() { return std::int32_t(m_in.byte() % 34) - 2; }
  std::vector<double> numbers(std::size_t n) {
    std::vector<double> v(n);
    for (double& x : v) x = 4.0 * m_in.number();
    return v;
  }
  std::vector<std::int32_t> nodes(std::size_t n) {
    std::vector<std::int32_t> v(n);
    for (std::int32_t& x : v) x = small();
    return v;
  }

  void furnish();
  void call(int which);
  void call_scene(int which);
  void call_stepper(int which);
  void call_results(int which);
  void make_mesh();
  void make_surface();
  void make_scene();
  void make_device();
  void make_stepper();
  void add_compartment();
  void insert();
  void read_bytes();
  void solve_problem();

  Numbers m_in;
  brs_context* m_context = nullptr;
  std::vector<Handle> m_handles;
  volatile double m_read = 0.0;   // what views show is there to be read
};

#define DESTROYS(type)                                                                     \
  template <>                                                                              \
  Calls::Destroy Calls::destroy_of<brs_##type>() {                                         \
    return [](void* handle) { return brs_##type##_destroy(static_cast<brs_##type*>(handle)); }; \
  }
DESTROYS(mesh)
DESTROYS(surface)
DESTROYS(scene)
DESTROYS(device)
DESTROYS(stepper)
DESTROYS(snapshot)
#undef DESTROYS

const TetShape& block() {
  static const TetShape shape = make_box(Vec3::Constant(30.0), 2, 2, 2);
  return shape;
}

// A block on its base in fluid under a lid, with a lead: what most calls need to get anywhere.
void Calls::furnish() {
  static const SurfaceShape wall = [] {
    SurfaceShape shape = make_box_surface({36.0, 36.0, 36.0});
    shape.points.rowwise() -= Eigen::RowVector3d(3.0, 3.0, 3.0);
    return shape;
  }();
  const auto good = [this](brs_status status) {
    if (status == BRS_OK) return;
    std::fprintf(stderr, "%s: %s\n", brs_status_name(status), brs_context_message(m_context));
    std::abort();
  };
  brs_mesh* mesh = nullptr;
  good(brs_mesh_create(m_context, block().points.data(), block().points.rows(), block().tets.data(),
                       block().tets.rows(), nullptr, 0, &mesh));
  keep(mesh);
  brs_surface* surface = nullptr;
  brs_surface_options coarse;
  brs_surface_options_init(&coarse, sizeof coarse);
  coarse.grid_spacing = 10.0;
  good(brs_surface_create(m_context, BRS_SURFACE_CAVITY, wall.points.data(), wall.points.rows(), wall.triangles.data(),
                          wall.triangles.rows(), &coarse, &surface));
  keep(surface);
  brs_scene* scene = nullptr;
  good(brs_scene_create(m_context, mesh, &scene));
  keep(scene);
  brs_material material;
  brs_material_init(&material, sizeof material);
  material.law = "corotational";
  material.young = 6.0;
  material.poisson = 0.45;
  material.density = 1.04e-6;
  good(brs_scene_set_material(scene, 0, &material));
  const std::int32_t base[] = {0, 1, 2, 3, 4, 5, 6, 7, 8}, lid[] = {18, 19, 20, 21, 22, 23, 24, 25, 26};
  good(brs_scene_add_fixed(scene, "base", base, 9, 7, nullptr));
  good(brs_scene_add_obstacle(scene, "lid", lid, 9, surface, 1, nullptr, 0, nullptr));
  std::vector<std::int32_t> faces(48);
  std::iota(faces.begin(), faces.end(), 0);
  brs_compartment fluid;
  brs_compartment_init(&fluid, sizeof fluid);
  fluid.name = "box";
  fluid.wall_points = wall.points.data();
  fluid.wall_point_count = wall.points.rows();
  fluid.wall_triangles = wall.triangles.data();
  fluid.wall_triangle_count = wall.triangles.rows();
  fluid.body_faces = fluid.wetted_faces = faces.data();
  fluid.body_face_count = fluid.wetted_face_count = std::int64_t(faces.size());
  good(brs_scene_set_csf(scene, 1e-6, BRS_CSF_SEPARATE, 33.0));
  good(brs_scene_add_compartment(scene, &fluid, nullptr));
  brs_stepper_options few;
  brs_stepper_options_init(&few, sizeof few);
  few.max_iterations = 4;
  few.smallest_load_step = 0.5;
  brs_stepper* stepper = nullptr;
  good(brs_stepper_create(scene, &few, &stepper));
  keep(stepper);
  brs_device* device = nullptr;
  good(brs_device_create_named(m_context, "3389", 30.0, nullptr, &device));
  keep(device);
}

// A block, a tet or two of any form, or its quadratic.
void Calls::make_mesh() {
  brs_mesh* mesh = nullptr;
  const std::uint8_t how = m_in.byte();
  if (how < 160) {
    expect(brs_mesh_create(m_context, block().points.data(), count(std::size_t(block().points.rows())),
                           block().tets.data(), count(std::size_t(block().tets.rows())), nullptr, how % 2, &mesh));
  } else if (how < 224) {
    const std::vector<double> points = numbers(15);
    const std::vector<std::int32_t> tets = nodes(8), regions = nodes(2);
    expect(brs_mesh_create(m_context, points.data(), 5, tets.data(), 2, regions.data(), how % 2, &mesh));
  } else {
    expect(brs_mesh_quadratic(any<brs_mesh>(), &mesh));
  }
  keep(mesh);
}

void Calls::make_surface() {
  static const SurfaceShape box = [] {
    SurfaceShape shape = make_box_surface({30.4, 30.4, 40.0});
    shape.points.rowwise() -= Eigen::RowVector3d(0.2, 0.2, 0.0);
    return shape;
  }();
  brs_surface* surface = nullptr;
  brs_surface_options options;
  brs_surface_options_init(&options, sizeof options);
  options.grid_spacing = 10.0;
  if (m_in.byte() > 240) options.band = m_in.number();
  expect(brs_surface_create(m_context, m_in.byte() % 3, box.points.data(), count(std::size_t(box.points.rows())),
                            box.triangles.data(), count(std::size_t(box.triangles.rows())), &options, &surface));
  keep(surface);
}

void Calls::make_scene() {
  brs_scene* scene = nullptr;
  expect(brs_scene_create(m_context, any<brs_mesh>(), &scene));
  if (!scene) return;
  keep(scene);
  brs_material material;
  brs_material_init(&material, sizeof material);
  const char* laws[] = {"linear", "corotational", "st_venant_kirchhoff", "stable_neo_hookean", "none", nullptr};
  const std::uint8_t law = m_in.byte();
  material.young = 6.0;
  material.poisson = 0.45;
  material.density = 1e-6;
  material.law = laws[law < 240 ? law % 4 : law % 6];
  if (m_in.byte() > 220) material.young = m_in.number();
  if (m_in.byte() > 220) material.poisson = m_in.number();
  expect(brs_scene_set_material(scene, law > 250 ? small() : 0, &material));
}

void Calls::make_device() {
  brs_device* device = nullptr;
  const std::uint8_t how = m_in.byte();
  if (how < 200) {
    const char* names[] = {"3389", "cannula", "no such device", nullptr};
    expect(brs_device_create_named(m_context, names[how < 190 ? how % 2 : how % 4],
                                   how < 100 ? 30.0 : 10.0 * m_in.number(), nullptr, &device));
  } else {
    const std::vector<double> points = numbers(9), sections = numbers(14), contacts = numbers(4);
    expect(brs_device_create(m_context, "any", points.data(), 3, sections.data(), count(2), contacts.data(), 2, nullptr,
                             0, &device));
  }
  keep(device);
}

void Calls::make_stepper() {
  brs_stepper* stepper = nullptr;
  brs_stepper_options options;
  brs_stepper_options_init(&options, sizeof options);
  options.max_iterations = 4;
  options.smallest_load_step = 0.5;
  if (m_in.byte() > 240) options.residual_tolerance = m_in.number();
  if (m_in.byte() > 240) options.threads = small();
  if (m_in.byte() > 240) options.struct_size = small();
  expect(brs_stepper_create(any<brs_scene>(), &options, &stepper));
  keep(stepper);
}

void Calls::add_compartment() {
  static const SurfaceShape wall = make_box_surface({60.0, 60.0, 60.0});
  brs_compartment compartment;
  brs_compartment_init(&compartment, sizeof compartment);
  std::vector<std::int32_t> faces(48);
  for (std::size_t i = 0; i < faces.size(); ++i) faces[i] = std::int32_t(i);
  compartment.name = "box";
  compartment.wall_points = wall.points.data();
  compartment.wall_point_count = count(std::size_t(wall.points.rows()));
  compartment.wall_triangles = wall.triangles.data();
  compartment.wall_triangle_count = wall.triangles.rows();
  compartment.body_faces = compartment.wetted_faces = faces.data();
  compartment.body_face_count = count(faces.size());
  compartment.wetted_face_count = count(faces.size());
  brs_scene* scene = any<brs_scene>();
  expect(brs_scene_set_csf(scene, 1e-6, m_in.byte() % 3, m_in.byte() < 200 ? 60.0 : m_in.number()));
  expect(brs_scene_add_compartment(scene, &compartment, nullptr));
}

void Calls::insert() {
  brs_hold hold;
  brs_hold_init(&hold, sizeof hold);
  if (m_in.byte() % 2) hold.rigid_from = m_in.number();
  if (m_in.byte() % 2) hold.anchor = 4.0 * m_in.number();
  brs_track_options track;
  brs_track_options_init(&track, sizeof track);
  track.shear_bound = m_in.byte() < 128 ? 0.1 : m_in.number();
  track.local_give = m_in.byte() % 2;
  const double tip[] = {14.3, 15.7, m_in.byte() < 200 ? 9.1 : m_in.number()};
  const double outward[] = {0.0, 0.0, m_in.byte() < 240 ? 1.0 : m_in.number()};
  brs_stepper* stepper = any<brs_stepper>();
  brs_device* device = any<brs_device>();
  std::int32_t id = -1;
  expect(brs_stepper_insert(stepper, device, tip, outward, &hold, m_in.byte() < 128 ? nullptr : &track, &id));
}

void Calls::read_bytes() {
  std::vector<std::uint8_t> bytes(1 << 16);
  std::int64_t size = 0;
  brs_stepper* stepper = any<brs_stepper>();
  const bool whole = m_in.byte() % 2;
  if (whole) {
    expect(brs_stepper_record(stepper, bytes.data(), std::int64_t(bytes.size()), &size));
  } else {
    expect(brs_snapshot_bytes(any<brs_snapshot>(), bytes.data(), std::int64_t(bytes.size()), &size));
  }
  size = std::min(size, std::int64_t(bytes.size()));
  if (size > 0 && m_in.byte() > 200) bytes[m_in.byte() % std::size_t(size)] ^= 1;
  brs_stepper* replayed = nullptr;
  brs_snapshot* snapshot = nullptr;
  if (whole) {
    expect(brs_stepper_replay(m_context, bytes.data(), count(std::size_t(size)), &replayed));
  } else {
    expect(brs_stepper_read_snapshot(stepper, bytes.data(), count(std::size_t(size)), &snapshot));
  }
  keep(replayed);
  keep(snapshot);
}

void Calls::solve_problem() {
  const std::vector<double> matrix = numbers(9), q = numbers(3), lower = numbers(3), upper = numbers(3);
  double z[3], w[3];
  brs_mcp_options options;
  brs_mcp_options_init(&options, sizeof options);
  options.method = m_in.byte() % 5;
  options.max_sweeps = 50;
  expect(brs_mcp_solve(m_context, matrix.data(), q.data(), lower.data(), upper.data(), count(3), &options, z, w,
                       nullptr, nullptr));
}

void Calls::call_scene(int which) {
  const std::vector<std::int32_t> held = nodes(4), partners = nodes(4);
  const std::vector<double> values = numbers(12);
  std::int32_t id = -1;
  brs_scene* scene = any<brs_scene>();
  brs_scene* other = nullptr;
  switch (which) {
    case 0: expect(brs_scene_set_gravity(scene, values.data())); break;
    case 1: expect(brs_scene_set_balanced_reference(scene, small())); break;
    case 2: expect(brs_scene_set_volume_strain(scene, small())); break;
    case 3: expect(brs_scene_quadratic(scene, &other)); keep(other); break;
    case 4: expect(brs_scene_add_fixed(scene, "held", held.data(), count(4), m_in.byte() % 9, &id)); break;
    case 5: expect(brs_scene_add_tied(scene, "tied", held.data(), partners.data(), count(4), &id)); break;
    case 6: expect(brs_scene_add_support(scene, "springs", held.data(), count(4), values.data(), count(4), &id)); break;
    case 7:
      expect(brs_scene_add_obstacle(scene, m_in.byte() < 250 ? "wall" : nullptr, held.data(), count(4),
                                    any<brs_surface>(), m_in.byte() < 200 ? 1 : small(), values.data(), count(1), &id));
      break;
    case 8:
      expect(brs_scene_add_opposing(scene, "falx", held.data(), partners.data(), values.data(), count(4), &id));
      break;
    case 9: expect(brs_scene_set_enabled(scene, small(), small())); break;
    case 10: expect(brs_scene_remove_constraint(scene, small())); break;
    default: add_compartment();
  }
}

void Calls::call_stepper(int which) {
  const std::vector<double> values = numbers(3);
  brs_stepper* stepper = any<brs_stepper>();
  brs_snapshot* snapshot = nullptr;
  brs_hold hold;
  brs_hold_init(&hold, sizeof hold);
  std::int32_t phase = -1;
  switch (which) {
    case 0: expect(brs_stepper_set_gravity(stepper, values.data())); break;
    case 1: expect(brs_stepper_set_enabled(stepper, small(), small())); break;
    case 2: expect(brs_stepper_set_csf(stepper, m_in.byte() < 200 ? 0 : small(), small(), 100.0 * values[0])); break;
    case 3: expect(brs_stepper_set_damping(stepper, values[0], values[1])); break;
    case 4: expect(brs_stepper_check_settings(stepper)); break;
    case 5: insert(); break;
    case 6: expect(brs_stepper_exchange(stepper, small(), any<brs_device>(), &hold, values[0])); break;
    case 7: expect(brs_stepper_set_hold(stepper, small(), &hold)); break;
    case 8: expect(brs_stepper_set_friction(stepper, small(), values[0], values[1])); break;
    case 9: expect(brs_stepper_remove_device(stepper, small())); break;
    case 10: expect(brs_stepper_solve_static(stepper, nullptr)); break;
    case 11: expect(brs_stepper_step(stepper, values[0], nullptr)); break;
    case 12: expect(brs_stepper_begin_static(stepper)); break;
    case 13: expect(brs_stepper_begin_step(stepper, values[0])); break;
    case 14: expect(brs_stepper_linearise(stepper)); break;
    case 15: expect(brs_stepper_solve(stepper)); break;
    case 16: expect(brs_stepper_update(stepper, &phase)); break;
    case 17: expect(brs_stepper_accept(stepper, nullptr)); break;
    case 18: expect(brs_stepper_reject(stepper)); break;
    case 19: expect(brs_stepper_snapshot(stepper, &snapshot)); keep(snapshot); break;
    case 20: expect(brs_stepper_restore(stepper, any<brs_snapshot>())); break;
    case 21: read_bytes(); break;
    default: expect(brs_context_set_cancel(m_context, m_in.byte() > 200)); break;
  }
}

void Calls::call_results(int which) {
  const std::vector<double> points = numbers(6);
  double out[6];
  std::int32_t tets[2];
  brs_stepper* stepper = any<brs_stepper>();
  brs_solve_report report;
  brs_solve_report_init(&report, sizeof report);
  brs_compartment_state fluid;
  brs_compartment_state_init(&fluid, sizeof fluid);
  brs_contact_state contact;
  brs_contact_state_init(&contact, sizeof contact);
  brs_device_state state;
  brs_device_state_init(&state, sizeof state);
  switch (which) {
    case 0: {
      const double* values = nullptr;
      std::int64_t rows = 0, columns = 0;
      const brs_status status = brs_stepper_field(stepper, small(), &values, &rows, &columns);
      expect(status);
      for (std::int64_t i = 0; status == BRS_OK && i < rows * columns; ++i) m_read = values[i];
      break;
    }
    case 1: expect(brs_stepper_displacement_at(stepper, points.data(), count(2), out, tets)); break;
    case 2: expect(brs_stepper_rest_points_of(stepper, points.data(), count(2), out, nullptr)); break;
    case 3: expect(brs_stepper_compartment(stepper, small(), &fluid)); break;
    case 4: expect(brs_stepper_contact(stepper, small(), &contact)); break;
    case 5: expect(brs_stepper_device(stepper, small(), &state)); break;
    case 6: expect(brs_stepper_progress_report(stepper, &report)); break;
    case 7: expect(brs_mesh_locate(any<brs_mesh>(), points.data(), count(2), tets, nullptr)); break;
    case 8: expect(brs_surface_distance(any<brs_surface>(), points.data(), count(2), out)); break;
    default: expect(brs_stepper_estimate_error(stepper, points.data(), 1, out, nullptr));
  }
}

void Calls::call(int which) {
  if (which < 12) return call_scene(which);
  if (which < 35) return call_stepper(which - 12);
  if (which < 45) return call_results(which - 35);
  switch (which) {
    case 45: return make_mesh();
    case 46: return make_surface();
    case 47: return make_scene();
    case 48: return make_device();
    case 49: return make_stepper();
    case 50: return solve_problem();
    default:
      if (!m_handles.empty()) destroy(m_in.byte() % m_handles.size());
  }
}

}  // namespace

void fuzz_calls(const std::uint8_t* data, std::size_t size) {
  Calls(data, size).run();
}

}  // namespace brainshift::test
