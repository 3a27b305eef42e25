// Constraints of a scene.
#include "arrays.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

// Runs add(constraints), which returns an id.
template <class Add>
brs_status add_group(brs_scene* scene, int32_t* id, Add&& add) noexcept {
  return guard(scene, [&](brs_scene& s) {
    const ConstraintId made = add(s.value.constraints);
    if (id) *id = made;
  });
}

std::array<bool, 3> axes_of(int32_t axes) {
  if (axes < 0 || axes > BRS_AXES)
    throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                  "axes is " + std::to_string(axes) + ", not a sum of BRS_AXIS_X, _Y and _Z");
  return {(axes & BRS_AXIS_X) != 0, (axes & BRS_AXIS_Y) != 0, (axes & BRS_AXIS_Z) != 0};
}

}  // namespace

brs_status brs_scene_set_enabled(brs_scene* scene, int32_t id, int32_t on) {
  return guard(scene, [&](brs_scene& s) {
    on ? s.value.constraints.enable(id) : s.value.constraints.disable(id);
  });
}

brs_status brs_scene_remove_constraint(brs_scene* scene, int32_t id) {
  return guard(scene, [&](brs_scene& s) { s.value.constraints.remove(id); });
}

brs_status brs_scene_add_fixed(brs_scene* scene, const char* name, const int32_t* nodes,
                               int64_t count, int32_t axes, int32_t* id) {
  return add_group(scene, id, [&](ConstraintSet& set) {
    return set.fix(text(name, "name"), indices(nodes, count, "nodes"), axes_of(axes));
  });
}

brs_status brs_scene_add_tied(brs_scene* scene, const char* name, const int32_t* nodes,
                              const int32_t* partners, int64_t count, int32_t* id) {
  return add_group(scene, id, [&](ConstraintSet& set) {
    return set.tie(text(name, "name"), indices(nodes, count, "nodes"),
                   indices(partners, count, "partners"));
  });
}

brs_status brs_scene_add_support(brs_scene* scene, const char* name, const int32_t* nodes,
                                 int64_t count, const double* stiffness, int64_t stiffness_count,
                                 int32_t* id) {
  return add_group(scene, id, [&](ConstraintSet& set) {
    return set.support(text(name, "name"), indices(nodes, count, "nodes"),
                       rows<Eigen::VectorXd>(stiffness, stiffness_count, "stiffnesses"));
  });
}

brs_status brs_scene_add_obstacle(brs_scene* scene, const char* name, const int32_t* nodes,
                                  int64_t count, brs_surface* surface, int32_t side,
                                  const double* offsets, int64_t offset_count, int32_t* id) {
  return add_group(scene, id, [&](ConstraintSet& set) {
    return set.obstacle(text(name, "name"), indices(nodes, count, "nodes"), checked(surface).value,
                        side, rows<Eigen::VectorXd>(offsets, offset_count, "offsets"));
  });
}

brs_status brs_scene_add_opposing(brs_scene* scene, const char* name, const int32_t* nodes,
                                  const int32_t* partners, const double* normals, int64_t count,
                                  int32_t* id) {
  return add_group(scene, id, [&](ConstraintSet& set) {
    return set.opposing(text(name, "name"), indices(nodes, count, "nodes"),
                        indices(partners, count, "partners"),
                        rows<Points>(normals, count, "normals"));
  });
}
