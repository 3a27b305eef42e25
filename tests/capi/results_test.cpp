// What the C face answers is what the C++ library answers, bit for bit.
#include <cstring>

#include "cpp_scene.hpp"
#include "world.hpp"

namespace brainshift::test {
namespace {

template <class Matrix>
std::vector<double> values_of(const Matrix& m) {
  return {m.data(), m.data() + m.size()};
}

class Results : public testing::Test {
 protected:
  World w;
  brs_solve_report report;
  Results() { brs_solve_report_init(&report, sizeof report); }
};

TEST_F(Results, OfASolveAreThoseOfTheCppLibrary) {
  Stepper cpp(cpp_scene());
  cpp.csf().set_lost_volume(0, 5000.0);
  const SolveReport expected = cpp.solve_static();
  w.good(w.solve_after_loss(5000.0, &report));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), values_of(cpp.displacement()));
  EXPECT_EQ(w.field(BRS_FIELD_POSITION), values_of(cpp.positions()));
  EXPECT_EQ(w.field(BRS_FIELD_JACOBIAN), values_of(cpp.jacobians()));
  EXPECT_EQ(w.field(BRS_FIELD_FLUID_PRESSURE), values_of(cpp.fluid_pressure()));
  EXPECT_EQ(w.field(BRS_FIELD_INTERNAL_FORCE), values_of(cpp.internal_force()));
  EXPECT_EQ(w.field(BRS_FIELD_GRAVITY_FORCE), values_of(cpp.gravity_force()));
  EXPECT_EQ(w.field(BRS_FIELD_FLUID_FORCE), values_of(cpp.fluid_force()));
  EXPECT_EQ(w.field(BRS_FIELD_EXTERNAL_FORCE), values_of(cpp.external_force()));
  EXPECT_EQ(report.status, BRS_OK);
  EXPECT_EQ(report.residual, expected.residual);
  EXPECT_EQ(report.complementarity, expected.complementarity);
  EXPECT_EQ(report.violation, expected.violation);
  EXPECT_EQ(report.last_correction, expected.last_correction);
  EXPECT_EQ(report.smallest_jacobian, expected.smallest_jacobian);
  EXPECT_EQ(report.tangent, BRS_TANGENT_POSITIVE_DEFINITE);
  EXPECT_EQ(report.blas_threads, expected.blas_threads);
  EXPECT_EQ(report.energy, expected.energy);
  EXPECT_EQ(report.load_factor, expected.load_factor);
  EXPECT_EQ(report.load_steps, expected.load_steps);
  EXPECT_EQ(report.iterations, expected.iterations);
  EXPECT_EQ(report.factorisations, expected.factorisations);
  EXPECT_EQ(report.shifted_factorisations, expected.shifted_factorisations);
  EXPECT_EQ(report.active_contacts, expected.active_contacts);
  EXPECT_GT(report.seconds, 0.0);
}

TEST_F(Results, OfFluidAndContactAreThoseOfTheCppLibrary) {
  Stepper cpp(cpp_scene());
  cpp.csf().set_lost_volume(0, 8000.0);
  cpp.solve_static();
  w.good(w.solve_after_loss(8000.0));
  const CompartmentState fluid = cpp.compartment(0);
  brs_compartment_state state;
  brs_compartment_state_init(&state, sizeof state);
  w.good(brs_stepper_compartment(w.stepper, 0, &state));
  EXPECT_EQ(state.head, fluid.head);
  EXPECT_EQ(state.fluid_volume, fluid.fluid_volume);
  EXPECT_EQ(state.air_volume, fluid.air_volume);
  EXPECT_EQ(state.tissue_volume, fluid.tissue_volume);
  EXPECT_EQ(state.lost_volume, fluid.lost_volume);
  EXPECT_EQ(state.open, 1);

  const ContactState sides = cpp.contact(w.contact);
  brs_contact_state contact;
  brs_contact_state_init(&contact, sizeof contact);
  w.good(brs_stepper_contact(w.stepper, w.contact, &contact));
  ASSERT_EQ(contact.count, sides.gap.size());
  EXPECT_EQ(contact.active, sides.active);
  EXPECT_EQ(Indices(contact.nodes, contact.nodes + contact.count), side_nodes());
  EXPECT_EQ(contact.partner_count, 0);
  EXPECT_EQ(std::memcmp(contact.gap, sides.gap.data(), std::size_t(contact.count) * 8), 0);
  EXPECT_EQ(
      std::memcmp(contact.multiplier, sides.multiplier.data(), std::size_t(contact.count) * 8), 0);
  EXPECT_EQ(std::memcmp(contact.force, sides.force.data(), std::size_t(contact.count) * 24), 0);
}

TEST_F(Results, AtPointsInvertEachOtherAndOutsideIsARemark) {
  w.good(w.solve_after_loss(5000.0));
  const double points[6] = {11.0, 12.0, 13.0, 20.0, 5.0, 25.0};
  double shift[6], moved[6], back[6];
  std::int32_t tets[2];
  w.good(brs_stepper_displacement_at(w.stepper, points, 2, shift, tets));
  EXPECT_GE(tets[0], 0);
  for (int i = 0; i < 6; ++i) moved[i] = points[i] + shift[i];
  w.good(brs_stepper_rest_points_of(w.stepper, moved, 2, back, nullptr));
  // 1e-9: the tolerance with which points are located, far above rounding of 30 mm.
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(back[i], points[i], 1e-9);

  double in_place[6] = {11.0, 12.0, 13.0, 500.0, 0.0, 0.0};
  EXPECT_EQ(brs_stepper_displacement_at(w.stepper, in_place, 2, in_place, tets), BRS_OUTSIDE);
  EXPECT_EQ(tets[1], -1);
  EXPECT_TRUE(std::isnan(in_place[3]));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(in_place[i], shift[i]);
  EXPECT_EQ(w.message(), "1 of 2 points lie outside the mesh");
}

TEST_F(Results, ArraysNeedNoAlignment) {
  std::vector<char> buffer(sizeof(double) * 3 + 1);
  const double point[3] = {11.0, 12.0, 13.0};
  std::memcpy(buffer.data() + 1, point, sizeof point);
  auto* odd = reinterpret_cast<double*>(buffer.data() + 1);
  double expected[3], values[3];
  w.good(w.solve_after_loss(5000.0));
  w.good(brs_stepper_displacement_at(w.stepper, point, 1, expected, nullptr));
  w.good(brs_stepper_displacement_at(w.stepper, odd, 1, odd, nullptr));
  std::memcpy(values, odd, sizeof values);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(values[i], expected[i]);
}

TEST_F(Results, ASnapshotBringsBackTheSameBitsAndTheSameFuture) {
  w.good(w.solve_after_loss(5000.0));
  brs_snapshot* kept = nullptr;
  w.good(brs_stepper_snapshot(w.stepper, &kept));
  const std::vector<double> state = w.field(BRS_FIELD_DISPLACEMENT);
  w.good(w.solve_after_loss(9000.0));
  const std::vector<double> future = w.field(BRS_FIELD_DISPLACEMENT);
  EXPECT_NE(future, state);
  w.good(brs_stepper_restore(w.stepper, kept));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), state);
  w.good(w.solve_after_loss(9000.0));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), future);
  brs_snapshot_destroy(kept);
}

TEST_F(Results, ThatDidNotConvergeAreARemarkAndLeaveTheState) {
  brs_stepper_options options;
  brs_stepper_options_init(&options, sizeof options);
  options.max_iterations = 1;
  options.smallest_load_step = 0.9;
  brs_stepper* hasty = nullptr;
  w.good(brs_stepper_create(w.scene, &options, &hasty));
  brs_stepper_destroy(w.stepper);
  w.stepper = hasty;
  EXPECT_EQ(w.solve_after_loss(9000.0, &report), BRS_NOT_CONVERGED);
  EXPECT_EQ(report.status, BRS_NOT_CONVERGED);
  EXPECT_NE(w.message(), "");
  for (double u : w.field(BRS_FIELD_DISPLACEMENT)) EXPECT_EQ(u, 0.0);
}

TEST_F(Results, OfTheMeshAreItsSurface) {
  const Mesh mesh(w.block.points, w.block.tets);
  const std::int32_t* triangles = nullptr;
  std::int64_t count = 0;
  w.good(brs_mesh_surface(w.mesh, &triangles, &count));
  ASSERT_EQ(count, mesh.surface().rows());
  EXPECT_EQ(std::memcmp(triangles, mesh.surface().data(), std::size_t(count) * 12), 0);
  EXPECT_EQ(w.body.size(), std::size_t(count));
  EXPECT_EQ(w.body.size() - w.wet.size(), std::size_t(2 * cells * cells));  // the base
  std::int32_t two[3] = {-5, -5, -5};
  w.good(brs_mesh_faces(w.mesh, 0, nullptr, 0, two, 2, &count));
  EXPECT_EQ(count, mesh.surface().rows());
  EXPECT_EQ(two[2], -5) << "no more than capacity";
}

TEST(Ownership, HandlesGoInAnyOrder) {
  World w;
  w.good(brs_context_destroy(w.context));
  w.context = nullptr;
  EXPECT_EQ(brs_mesh_destroy(w.mesh), BRS_OK);
  EXPECT_EQ(brs_surface_destroy(w.surface), BRS_OK);
  EXPECT_EQ(brs_scene_destroy(w.scene), BRS_OK);
  w.mesh = nullptr, w.surface = nullptr, w.scene = nullptr;
  EXPECT_EQ(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0), BRS_OK);
  EXPECT_EQ(brs_stepper_solve_static(w.stepper, nullptr), BRS_OK);
  EXPECT_EQ(brs_stepper_destroy(w.stepper), BRS_OK);
  w.stepper = nullptr;
}

TEST(Ownership, AMeshOfOneContextServesScenesOfAnother) {
  World w;
  brs_context* second = nullptr;
  brs_scene* scene = nullptr;
  w.good(brs_context_create(BRS_VERSION, &second));
  w.good(brs_scene_create(second, w.mesh, &scene));
  brs_context_destroy(second);
  brs_scene_destroy(scene);
}

}  // namespace
}  // namespace brainshift::test
