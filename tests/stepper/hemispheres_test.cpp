// Two halves side by side in a cavity, a falx between them, tied to each other low in the middle:
// the signs of what happens when fluid is lost on one side.
//
//        left   |   right          z up, gravity -z; x to the right
//      +------+ | +------+         the falx is the plane x = 0 above 0.6 of the height;
//      |      | | |      |         below it the halves touch; the lowest cells are tied
//      +------+---+------+
#include <algorithm>

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace brainshift {
namespace {

constexpr double side = 40.0, deep = 40.0, high = 40.0, margin = 3.0;
constexpr double bridge_top = 10.0;
constexpr int cells = 4;

struct Head {
  Scene scene;
  Indices left, right;                // all nodes of a half
  Indices medial_left, medial_right;  // node by node across the midline
};

struct Options {
  bool falx = true;
  bool contact = true;
  FluidModel model = FluidModel::separate;
};

Points mirrored(Points p) {
  p.col(0) = -p.col(0);
  return p;
}

// The left half is the mirror image of the right, tets and all.
Mesh two_halves() {
  const auto right = test::make_box({side, deep, high}, cells, cells, cells);
  test::TetShape left = right;
  left.points = mirrored(left.points);
  left.tets.col(2).swap(left.tets.col(3));
  Indices regions(std::size_t(2 * right.tets.rows()), 0);
  std::fill(regions.begin() + right.tets.rows(), regions.end(), 1);
  return test::make_mesh(test::joined(left, right), regions);
}

Head make_head(const Options& o) {
  const Mesh mesh = two_halves();
  const Index half = mesh.node_count() / 2;
  Head head{{mesh,
             {{0, Material(Law::corotational, 6.0, 0.45, test::tissue_density)},
              {1, Material(Law::corotational, 6.0, 0.45, test::tissue_density)}},
             Vec3(0, 0, -standard_gravity),
             {},
             {}},
            {},
            {},
            {},
            {}};
  for (Index i = 0; i < half; ++i) {
    head.left.push_back(i);
    head.right.push_back(i + half);
    if (mesh.nodes()(i, 0) == 0.0) {
      head.medial_left.push_back(i);
      head.medial_right.push_back(i + half);  // same place: the mirror image of a box
    }
  }
  // Lowest cells of the interface tied (the bridge), the rest of it one-sided.
  Indices tied_left, tied_right, free_left, free_right, falx_left, falx_right;
  const double falx_edge = 0.6 * high;
  for (std::size_t k = 0; k < head.medial_left.size(); ++k) {
    const double z = mesh.nodes()(head.medial_left[k], 2);
    if (z <= bridge_top) {
      tied_left.push_back(head.medial_left[k]);
      tied_right.push_back(head.medial_right[k]);
    } else if (o.falx && z > falx_edge) {
      falx_left.push_back(head.medial_left[k]);
      falx_right.push_back(head.medial_right[k]);
    } else {
      free_left.push_back(head.medial_left[k]);
      free_right.push_back(head.medial_right[k]);
    }
  }
  ConstraintSet& set = head.scene.constraints;
  set.fix("brainstem", test::nodes_where(mesh, [](const Vec3& x) {
            return x.z() == 0.0 && std::abs(x.x()) <= 10.0;
          }));
  set.tie("bridge", tied_left, tied_right);
  Points normal = Points::Zero(Eigen::Index(free_left.size()), 3);
  normal.col(0).setOnes();  // from left to right
  set.opposing("midline", free_right, free_left, normal);
  if (o.falx) {
    const test::SurfaceShape flat = test::make_sheet(deep + 20, high, 10, 8);
    Points p(flat.points.rows(), 3);  // normal +x
    for (Eigen::Index i = 0; i < p.rows(); ++i) {
      p.row(i) << 0.0, flat.points(i, 0) - 10.0, flat.points(i, 1) + falx_edge;
    }
    const Surface sheet = Surface::sheet(p, flat.triangles);
    set.obstacle("falx right", falx_right, sheet, 1.0);
    set.obstacle("falx left", falx_left, sheet, -1.0);
  }
  if (o.contact) {
    const auto skull = test::box_wall({-side - margin, -margin, -margin},
                                      {side + margin, deep + margin, high + margin});
    set.obstacle("skull", test::surface_nodes(mesh),
                 Surface::cavity(skull.points, skull.triangles));
  }
  // Tissue goes on across the bridge; all else is wetted.
  const Indices across = mesh.faces_within(
      test::nodes_where(mesh, [](const Vec3& x) { return x.x() == 0.0 && x.z() <= bridge_top; }));
  const auto compartment = [&](const char* name, double low, double up, Index region) {
    Compartment c = test::make_compartment(
        name, test::box_wall({low, -margin, -margin}, {up, deep + margin, high + margin}),
        mesh.faces_of_region(region));
    for (Index f : across) {
      c.wetted_faces.erase(std::remove(c.wetted_faces.begin(), c.wetted_faces.end(), f),
                           c.wetted_faces.end());
    }
    return c;
  };
  head.scene.csf.emplace(test::fluid_density, o.model,
                         std::vector<Compartment>{compartment("left", -side - margin, 0.0, 0),
                                                  compartment("right", 0.0, side + margin, 1)});
  return head;
}

// A solved head: `lost` (mm^3) of the fluid of one side gone.
struct Result {
  Stepper stepper;
  Head head;
  explicit Result(const Options& o, Index opened = 1, double lost = 12000.0)
      : Result(make_head(o), opened, lost) {}
  Result(Head made, Index opened, double lost) : stepper(made.scene), head(std::move(made)) {
    stepper.csf().set_lost_volume(opened, lost);
    const SolveReport report = stepper.solve_static();
    EXPECT_TRUE(report.converged()) << report.message;
    EXPECT_LE(report.residual, 1e-8);
    EXPECT_LE(report.complementarity, 1e-8);
    EXPECT_GT(report.smallest_jacobian, 0.0);
  }
  double largest(const Indices& nodes) const {
    double most = 0.0;
    for (Index i : nodes) most = std::max(most, stepper.displacement().row(i).norm());
    return most;
  }
  // Mean x of nodes of the midline: of the left half's upper ones, and of the bridge's upper edge.
  double left_midline() const { return mean_x(0.5 * high, high); }
  double bridge() const { return mean_x(bridge_top, bridge_top); }
  double mean_x(double low, double up) const {
    Indices nodes;
    for (Index i : head.medial_left) {
      const double z = stepper.mesh().nodes()(i, 2);
      if (z >= low && z <= up) nodes.push_back(i);
    }
    return test::mean_row(stepper.displacement(), nodes).x();
  }
  double top(const Indices& nodes) const {
    Indices on_top;
    for (Index i : nodes) {
      if (stepper.mesh().nodes()(i, 2) == high) on_top.push_back(i);
    }
    return test::mean_row(stepper.displacement(), on_top).z();
  }
};

TEST(Hemispheres, InFullFluidNothingMoves) {
  Stepper stepper(make_head({}).scene);
  ASSERT_TRUE(stepper.solve_static().converged());
  EXPECT_LE(stepper.displacement().cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Hemispheres, TheOpenedSideMovesMoreThanTheOther) {
  const Result r({});
  EXPECT_GT(r.largest(r.head.right), 2.0 * r.largest(r.head.left));
}

TEST(Hemispheres, TheUncoveredSideSinks) {
  const Result r({});
  EXPECT_LT(r.top(r.head.right), -0.05);
}

TEST(Hemispheres, TheMidlineMovesTowardsTheSideThatLostItsFluid) {
  // Across the bridge the pressure on the full side is no longer answered from the right; above it
  // the left half follows the bridge unless the falx stands in its way.
  for (bool contact : {true, false}) {
    Options without;
    without.falx = false;
    without.contact = contact;
    const Result r(without);
    EXPECT_GT(r.bridge(), 0.1);
    EXPECT_GT(r.left_midline(), 0.1);
  }
}

TEST(Hemispheres, TheFalxShieldsTheOtherSide) {
  Options without;
  without.falx = false;
  const Result free(without), held({});
  EXPECT_LT(std::abs(held.left_midline()), 0.1 * free.left_midline());
  EXPECT_GT(free.largest(free.head.left), 2.0 * held.largest(held.head.left));
}

TEST(Hemispheres, NodesKeepTheirSideOfTheFalx) {
  const Result r({});
  for (std::size_t k = 0; k < r.head.medial_left.size(); ++k) {
    if (r.stepper.mesh().nodes()(r.head.medial_left[k], 2) <= 0.6 * high) continue;
    EXPECT_LE(r.stepper.positions()(r.head.medial_left[k], 0), 1e-7);
    EXPECT_GE(r.stepper.positions()(r.head.medial_right[k], 0), -1e-7);
  }
}

TEST(Hemispheres, InTheCommunicatingFluidTheMidlineMovesLessAndTheClosedSideSwells) {
  // One head on both sides: no difference of pressure across the bridge; and the closed side feels
  // the fallen head as well.
  Options o;
  for (bool falx : {true, false}) {
    o.falx = falx;
    o.model = FluidModel::separate;
    const Result separate(o);
    o.model = FluidModel::communicating;
    const Result communicating(o);
    EXPECT_LT(communicating.bridge(), 0.9 * separate.bridge());
    EXPECT_GT(communicating.stepper.compartment(0).tissue_volume,
              separate.stepper.compartment(0).tissue_volume + 100.0);
    EXPECT_EQ(communicating.stepper.compartment(0).head, communicating.stepper.compartment(1).head);
    // What is lost is lost to both: the volume balance of all tissue
    double air = 0.0, growth = 0.0;
    for (Index c : {0, 1}) {
      const CompartmentState s = communicating.stepper.compartment(c);
      air += s.air_volume;
      growth += s.tissue_volume - side * deep * high;
    }
    EXPECT_NEAR(air, 12000.0 - growth, 1e-3);
  }
}

TEST(Hemispheres, TiedNodesMoveTogether) {
  const Result r({});
  for (std::size_t k = 0; k < r.head.medial_left.size(); ++k) {
    if (r.stepper.mesh().nodes()(r.head.medial_left[k], 2) > bridge_top) continue;
    EXPECT_EQ((r.stepper.displacement().row(r.head.medial_left[k]) -
               r.stepper.displacement().row(r.head.medial_right[k]))
                  .norm(),
              0.0);
  }
}

TEST(Hemispheres, LossOnTheLeftIsTheMirrorImageOfLossOnTheRight) {
  for (bool falx : {true, false}) {
    Options o;
    o.falx = falx;
    const Result right(o, 1), left(o, 0);
    const Index half = right.stepper.mesh().node_count() / 2;
    Points image(2 * half, 3);
    image << mirrored(left.stepper.displacement().bottomRows(half)),
        mirrored(left.stepper.displacement().topRows(half));
    // to solver tolerance
    EXPECT_LE(test::largest_distance(image, right.stepper.displacement()), 1e-6) << falx;
  }
}

TEST(Hemispheres, EqualLossOnBothSidesLeavesTheMidlineInPlace) {
  Head head = make_head({});
  Stepper stepper(head.scene);
  for (Index side_number : {0, 1}) stepper.csf().set_lost_volume(side_number, 10000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  const Index half = stepper.mesh().node_count() / 2;
  EXPECT_LE(test::largest_distance(mirrored(stepper.displacement().topRows(half)),
                                   stepper.displacement().bottomRows(half)),
            1e-6);
  EXPECT_NEAR(stepper.compartment(0).head, stepper.compartment(1).head, 1e-8);
}

TEST(Hemispheres, RestoringTheFluidBringsEveryNodeBack) {
  for (bool falx : {true, false}) {
    Options o;
    o.falx = falx;
    Result r(o);
    r.stepper.csf().set_lost_volume(0, 8000.0);
    ASSERT_TRUE(r.stepper.solve_static().converged());
    for (Index i : {0, 1}) r.stepper.csf().set_full(i);
    const SolveReport report = r.stepper.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    EXPECT_LE(r.stepper.displacement().cwiseAbs().maxCoeff(), 1e-6) << falx;
  }
}

TEST(Hemispheres, AStageSplitInTwoEndsAtTheSameState) {
  const Result once({}, 1, 12000.0);
  Result twice({}, 1, 5000.0);
  twice.stepper.csf().set_lost_volume(1, 12000.0);
  ASSERT_TRUE(twice.stepper.solve_static().converged());
  EXPECT_LE(test::largest_distance(once.stepper.displacement(), twice.stepper.displacement()),
            1e-6);
}

TEST(Hemispheres, AirIsWhatWasLostLessTheSwellingOfTheTissue) {
  // Fluid is conserved: air = lost - (tissue now - tissue at rest), per side.
  const Result r({});
  const CompartmentState s = r.stepper.compartment(1);
  const double rest = side * deep * high;
  EXPECT_NEAR(s.air_volume, 12000.0 - (s.tissue_volume - rest), 1e-3);
  EXPECT_EQ(r.stepper.compartment(0).air_volume, 0.0);
  // The side that is not open keeps its head.
  EXPECT_EQ(r.stepper.compartment(0).head, high + margin);
}

}  // namespace
}  // namespace brainshift
