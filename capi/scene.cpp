// Scene: materials, elements, gravity, CSF.
#include <algorithm>
#include <limits>
#include <memory>

#include "arrays.hpp"
#include "structs.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

brs_material material_defaults() {
  return {sizeof(brs_material), nullptr, not_given, not_given, not_given};
}

brs_compartment compartment_defaults() {
  brs_compartment none{};
  none.struct_size = sizeof none;
  return none;
}

FluidModel model_of(int32_t model) {
  switch (model) {
    case BRS_CSF_SEPARATE: return FluidModel::separate;
    case BRS_CSF_COMMUNICATING: return FluidModel::communicating;
    default:
      throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                    "there is no fluid model with the number " + std::to_string(model));
  }
}

VolumeStrain volume_strain_of(int32_t number) {
  switch (number) {
    case BRS_VOLUME_STRAIN_ELEMENT: return VolumeStrain::element;
    case BRS_VOLUME_STRAIN_NODAL: return VolumeStrain::nodal;
    default:
      throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                    "there is no volume strain with the number " + std::to_string(number));
  }
}

Compartment compartment_of(const brs_compartment& c) {
  return {text(c.name, "compartment->name"),
          rows<Points>(c.wall_points, c.wall_point_count, "wall points"),
          rows<Triangles>(c.wall_triangles, c.wall_triangle_count, "wall triangles"),
          indices(c.body_faces, c.body_face_count, "body faces"),
          indices(c.wetted_faces, c.wetted_face_count, "wetted faces")};
}

}  // namespace

brs_status brs_scene_create(brs_context* context, brs_mesh* mesh, brs_scene** scene) {
  return create(context, scene, "scene",
                [&](brs_context& c) { return new brs_scene(c.context, checked(mesh).value); });
}

brs_status brs_scene_destroy(brs_scene* scene) { return destroy(scene); }

brs_status brs_material_init(brs_material* material, int64_t struct_size) {
  return init(material, struct_size, material_defaults());
}

brs_status brs_scene_set_material(brs_scene* scene, int32_t region, const brs_material* material) {
  return guard(scene, [&](brs_scene& s) {
    const brs_material m = read(material, material_defaults(), "material");
    const Material value(law_from_name(text(m.law, "material->law")), m.young, m.poisson,
                         m.density);
    for (auto& [known, assigned] : s.value.materials) {
      if (known != region) continue;
      assigned = value;
      return;
    }
    s.value.materials.emplace_back(region, value);
  });
}

brs_status brs_scene_set_gravity(brs_scene* scene, const double* gravity) {
  return guard(scene, [&](brs_scene& s) {
    const Vec3 value = vector3(gravity, "gravity");
    if (!value.allFinite()) throw Refusal(BRS_ERROR_NOT_FINITE, "gravity is not finite");
    s.value.gravity = value;
  });
}

brs_status brs_scene_set_balanced_reference(brs_scene* scene, int32_t balanced) {
  return guard(scene, [&](brs_scene& s) { s.value.balanced_reference = balanced != 0; });
}

brs_status brs_scene_set_volume_strain(brs_scene* scene, int32_t volume_strain) {
  return guard(scene,
               [&](brs_scene& s) { s.value.volume_strain = volume_strain_of(volume_strain); });
}

brs_status brs_scene_quadratic(brs_scene* scene, brs_scene** quadratic) {
  return create(scene, quadratic, "quadratic", [](brs_scene& s) {
    auto made =
        std::make_unique<brs_scene>(s);  // compartments hold faces, which keep their numbers
    made->value = brainshift::quadratic(s.value);
    return made.release();
  });
}

brs_status brs_scene_set_csf(brs_scene* scene, double density, int32_t model,
                             double reference_head) {
  return guard(scene, [&](brs_scene& s) {
    const CsfPlan plan{density, model_of(model), reference_head};
    if (!s.compartments.empty()) Csf(plan.density, plan.model, s.compartments, reference_head);
    s.csf = plan;
  });
}

brs_status brs_compartment_init(brs_compartment* compartment, int64_t struct_size) {
  return init(compartment, struct_size, compartment_defaults());
}

brs_status brs_scene_add_compartment(brs_scene* scene, const brs_compartment* compartment,
                                     int32_t* index) {
  return guard(scene, [&](brs_scene& s) {
    const brs_compartment given = read(compartment, compartment_defaults(), "compartment");
    if (!s.csf)
      throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                    "the scene has no CSF to fill a compartment: call brs_scene_set_csf first");
    std::vector<Compartment> all = s.compartments;
    all.push_back(compartment_of(given));
    const Csf valid(s.csf->density, s.csf->model, all, s.csf->reference_head);  // or it throws
    if (index) *index = int32_t(s.compartments.size());
    s.compartments = std::move(all);
  });
}
