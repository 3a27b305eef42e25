// Each kind of constraint reaches the library as it was given.
#include "brainshift/brainshift.hpp"
#include "world.hpp"

namespace brainshift::test {
namespace {

// Two blocks, one on top of the other, 1 mm apart; the lower one is held at its base.
struct Pair {
  TetShape shape;
  Indices base, lower, upper, corner;

  Pair() {
    const TetShape one = make_box(Vec3::Constant(10.0), 2, 2, 2);
    const Index n = Index(one.points.rows());
    shape.points.resize(2 * n, 3);
    shape.points << one.points, one.points;
    shape.points.bottomRows(n).col(2).array() += 10.0;
    shape.tets.resize(2 * one.tets.rows(), 4);
    shape.tets << one.tets, (one.tets.array() + n).matrix();
    for (Index i = 0; i < 9; ++i) {
      base.push_back(i);
      lower.push_back(box_node(2, 2, 0, 0, 2) + i);
      upper.push_back(n + i);
    }
    corner = {n + 26};
  }
};

class Constraints : public testing::Test {
 protected:
  Pair pair;
  brs_context* context = nullptr;
  brs_mesh* mesh = nullptr;
  brs_scene* scene = nullptr;
  Points displacement;

  void good(brs_status status) { ASSERT_EQ(status, BRS_OK) << brs_context_message(context); }

  void SetUp() override {
    good(brs_context_create(BRS_VERSION, &context));
    good(brs_mesh_create(context, pair.shape.points.data(), pair.shape.points.rows(),
                         pair.shape.tets.data(), pair.shape.tets.rows(), nullptr, 0, &mesh));
    good(brs_scene_create(context, mesh, &scene));
    const brs_material material = tissue();
    good(brs_scene_set_material(scene, 0, &material));
    good(brs_scene_set_balanced_reference(scene, 0));
    good(brs_scene_add_fixed(scene, "base", pair.base.data(), 9, BRS_AXES, nullptr));
  }

  void TearDown() override {
    brs_scene_destroy(scene);
    brs_mesh_destroy(mesh);
    brs_context_destroy(context);
  }

  // Solves, and compares with the same in C++, bit for bit.
  void expect_same_as(ConstraintSet cpp, const Vec3& gravity = {1000.0, 0.0, -standard_gravity}) {
    good(brs_scene_set_gravity(scene, gravity.data()));
    brs_stepper* stepper = nullptr;
    good(brs_stepper_create(scene, nullptr, &stepper));
    good(brs_stepper_solve_static(stepper, nullptr));
    const double* u = nullptr;
    good(brs_stepper_field(stepper, BRS_FIELD_DISPLACEMENT, &u, nullptr, nullptr));
    if (HasFatalFailure()) return brs_stepper_destroy(stepper), void();
    displacement = Eigen::Map<const Points>(u, pair.shape.points.rows(), 3);
    brs_stepper_destroy(stepper);

    Scene same{Mesh(pair.shape.points, pair.shape.tets),
               {{0, Material(Law::stable_neo_hookean, 3.0, 0.45, 1.04e-6)}}};
    same.gravity = gravity;
    same.balanced_reference = false;
    same.constraints = std::move(cpp);
    Stepper expected(same);
    ASSERT_TRUE(expected.solve_static().converged());
    EXPECT_EQ(displacement, expected.displacement());
    EXPECT_GT(displacement.cwiseAbs().maxCoeff(), 0.0);
  }

  ConstraintSet held() {
    ConstraintSet set;
    set.fix("base", pair.base);
    return set;
  }
};

TEST_F(Constraints, TiedNodesMoveTogether) {
  std::int32_t id = -1;
  good(brs_scene_add_tied(scene, "seam", pair.upper.data(), pair.lower.data(), 9, &id));
  ConstraintSet set = held();
  EXPECT_EQ(id, set.tie("seam", pair.upper, pair.lower));
  expect_same_as(set);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_EQ(displacement.row(pair.upper[i]), displacement.row(pair.lower[i]));
}

TEST_F(Constraints, AxesAreFixedOneByOne) {
  const auto& n = pair.upper;
  good(brs_scene_add_fixed(scene, "rails", n.data(), 9, BRS_AXIS_X | BRS_AXIS_Y, nullptr));
  const Indices stops{n[0], n[2], n[6]};
  good(brs_scene_add_fixed(scene, "stops", stops.data(), 3, BRS_AXIS_Z, nullptr));
  ConstraintSet set = held();
  set.fix("rails", n, {true, true, false});
  set.fix("stops", stops, {false, false, true});
  expect_same_as(set);
  EXPECT_EQ(displacement(n[4], 0), 0.0);
  EXPECT_NE(displacement(n[4], 2), 0.0);
}

TEST_F(Constraints, SupportsTakeOneStiffnessOrOnePerNode) {
  const double one = 2.0, bad[2] = {1.0, 2.0};
  std::vector<double> each;
  for (int i = 0; i < 9; ++i) each.push_back(0.5 * (i + 1));
  const auto& n = pair.upper;
  EXPECT_EQ(brs_scene_add_support(scene, "bad", n.data(), 9, bad, 2, nullptr),
            BRS_ERROR_SIZE_MISMATCH);
  good(brs_scene_add_support(scene, "soft", n.data(), 9, &one, 1, nullptr));
  good(brs_scene_add_support(scene, "graded", n.data(), 9, each.data(), 9, nullptr));
  ConstraintSet set = held();
  set.support("soft", n, Eigen::VectorXd::Constant(1, one));
  set.support("graded", n, Eigen::Map<Eigen::VectorXd>(each.data(), 9));
  expect_same_as(set);
}

TEST_F(Constraints, OpposingNodesDoNotPassThroughEachOther) {
  Points up(9, 3);
  up.rowwise() = Eigen::RowVector3d(0.0, 0.0, 1.0);
  const double soft = 0.5;
  std::int32_t id = -1;
  good(brs_scene_add_opposing(scene, "slide", pair.upper.data(), pair.lower.data(), up.data(), 9,
                              &id));
  good(brs_scene_add_support(scene, "soft", pair.upper.data(), 9, &soft, 1, nullptr));
  ConstraintSet set = held();
  set.opposing("slide", pair.upper, pair.lower, up);
  set.support("soft", pair.upper, Eigen::VectorXd::Constant(1, soft));
  expect_same_as(set);
  brs_stepper* stepper = nullptr;
  brs_contact_state state;
  brs_contact_state_init(&state, sizeof state);
  good(brs_stepper_create(scene, nullptr, &stepper));
  good(brs_stepper_contact(stepper, id, &state));
  EXPECT_EQ(Indices(state.nodes, state.nodes + state.count), pair.upper);
  EXPECT_EQ(Indices(state.partners, state.partners + state.partner_count), pair.lower);
  brs_stepper_destroy(stepper);
  EXPECT_EQ(brs_scene_add_opposing(scene, "x", pair.upper.data(), pair.lower.data(),
                                   pair.shape.points.data(), 9, nullptr),
            BRS_ERROR_INVALID_ARGUMENT);
}

TEST_F(Constraints, ObstaclesKeepTheOffsetsTheyAreGiven) {
  // A sheet beside the blocks, 0.5 mm away; the nodes of the free corner edge keep their distance.
  SurfaceShape shape = make_sheet(60.0, 60.0, 2, 2);
  Points turned(shape.points.rows(), 3);  // into the plane x = 10.5, normal +x
  turned << Points(shape.points).col(2).array() + 10.5, shape.points.col(0).array() - 20.0,
      shape.points.col(1).array() - 20.0;
  const double soft = 0.5, point[3] = {10.0, 10.0, 20.0};
  brs_surface* sheet = nullptr;
  double distance = 0.0, offset = 0.0;
  good(brs_surface_create(context, BRS_SURFACE_SHEET, turned.data(), turned.rows(),
                          shape.triangles.data(), shape.triangles.rows(), nullptr, &sheet));
  good(brs_surface_distance(sheet, point, 1, &distance));
  EXPECT_NEAR(distance, -0.5, 1e-6);  // spline of a plane: exact but for rounding
  offset = -distance;
  good(
      brs_scene_add_obstacle(scene, "falx", pair.corner.data(), 1, sheet, -1, &offset, 1, nullptr));
  good(brs_scene_add_support(scene, "soft", pair.upper.data(), 9, &soft, 1, nullptr));
  ConstraintSet set = held();
  set.obstacle("falx", pair.corner, Surface::sheet(turned, shape.triangles), -1.0,
               Eigen::VectorXd::Constant(1, offset));
  set.support("soft", pair.upper, Eigen::VectorXd::Constant(1, soft));
  expect_same_as(set, {5000.0, 0.0, 0.0});
  EXPECT_NEAR(displacement(pair.corner[0], 0), 0.0, 1e-6);
  EXPECT_GT(displacement(pair.corner[0] - 2, 0), 1e-3);
  EXPECT_EQ(
      brs_scene_add_obstacle(scene, "x", pair.corner.data(), 1, sheet, 2, nullptr, 0, nullptr),
      BRS_ERROR_INVALID_ARGUMENT);
  brs_surface_destroy(sheet);
}

}  // namespace
}  // namespace brainshift::test
