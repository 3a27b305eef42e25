// Derivatives of the fluid's load by central differences.
#include <gtest/gtest.h>

#include "fluid/fluid_scenes.hpp"

namespace brainshift {
namespace {

using Dense = Eigen::MatrixXd;

Eigen::VectorXd flat(const Points& p) {
  return Eigen::Map<const Eigen::VectorXd>(p.data(), p.size());
}

std::vector<Indices> neighbours(const Mesh& mesh) {
  std::vector<Indices> near(std::size_t(mesh.node_count()));
  for (Index i = 0; i < mesh.node_count(); ++i) {
    for (Index j = 0; j < mesh.node_count(); ++j) {
      if (i != j) near[std::size_t(i)].push_back(j);
    }
  }
  return near;
}

Dense dense(const BlockMatrix& K) {
  Dense full(3 * K.blocks(), 3 * K.blocks());
  Eigen::VectorXd y;
  for (Index j = 0; j < 3 * K.blocks(); ++j) {
    K.multiply(Eigen::VectorXd::Unit(3 * K.blocks(), j), y);
    full.col(j) = y;
  }
  return full;
}

// d f/dx by central differences of f(x).
template <class F>
Dense differences(const Points& x, double step, F&& f) {
  Dense D;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    Points plus = x, minus = x;
    plus.data()[j] += step;
    minus.data()[j] -= step;
    const Eigen::VectorXd column = (f(plus) - f(minus)) / (2.0 * step);
    if (j == 0) D.resize(column.size(), x.size());
    D.col(j) = column;
  }
  return D;
}

struct Case : test::BallInCavity {
  Hydrostatics fluid;
  Indices slots;
  Points x;
  explicit Case(bool quadratic = false)
      : BallInCavity(30.0, 2, 40.0, quadratic),
        fluid(mesh, csf, test::gravity_down),
        slots(test::all_nodes(mesh)),
        x(test::shaken(mesh, 2.0)) {}
  Dense tangent(const std::vector<double>& heads) const {
    BlockMatrix K(neighbours(mesh));
    fluid.add_tangent(x, heads, slots, K);
    return dense(K);
  }
};

TEST(FluidTangent, IsMinusTheSlopeOfTheForceOnAClosedBodyAlsoPartlyWet) {
  const Case c;
  for (double head : {45.0, 12.3, 0.7, -14.0}) {
    const Dense K = c.tangent({head});
    const Dense D = differences(c.x, 1e-4, [&](const Points& x) {
      return Eigen::VectorXd(-flat(test::force_at(c.fluid, x, {head})));
    });
    // Round-off 1e-16 |f| / step ~ 1e-12, truncation step^2 f''' ~ 1e-10 of the entries
    EXPECT_LT((K - D).cwiseAbs().maxCoeff(), 1e-6 * D.cwiseAbs().maxCoeff()) << head;
    EXPECT_LT((D - D.transpose()).cwiseAbs().maxCoeff(), 1e-6 * D.cwiseAbs().maxCoeff()) << head;
  }
}

TEST(FluidTangent, OfAnOpenSurfaceIsTheSymmetricPart) {
  Case c;
  Compartment open = c.csf.compartment(0);
  open.wetted_faces.resize(open.wetted_faces.size() / 2);
  c.csf = Csf(test::fluid_density, FluidModel::separate, {open});
  c.fluid = Hydrostatics(c.mesh, c.csf, test::gravity_down);
  const Dense K = c.tangent({12.3});
  const Dense D = differences(c.x, 1e-4, [&](const Points& x) {
    return Eigen::VectorXd(-flat(test::force_at(c.fluid, x, {12.3})));
  });
  EXPECT_LT((K - 0.5 * (D + D.transpose())).cwiseAbs().maxCoeff(), 1e-6 * D.cwiseAbs().maxCoeff());
}

// The load on quadratic faces has its own symmetric part, whatever wets them: the depth is taken to
// be linear over the quarters of a face.
TEST(FluidTangent, OfQuadraticFacesIsTheSymmetricPart) {
  const Case c(true);
  for (double head : {45.0, 12.3, 0.7, -14.0}) {
    const Dense K = c.tangent({head});
    const Dense D = differences(c.x, 1e-4, [&](const Points& x) {
      return Eigen::VectorXd(-flat(test::force_at(c.fluid, x, {head})));
    });
    EXPECT_LT((K - 0.5 * (D + D.transpose())).cwiseAbs().maxCoeff(),
              1e-6 * D.cwiseAbs().maxCoeff())
        << head;
    EXPECT_LT((D - D.transpose()).cwiseAbs().maxCoeff(), 0.3 * D.cwiseAbs().maxCoeff()) << head;
  }
}

TEST(FluidTangent, OfTheReferenceCancelsThatOfTheFullFluid) {
  const Case c;
  BlockMatrix K(neighbours(c.mesh));
  c.fluid.add_tangent(c.x, c.fluid.heads(c.x), c.slots, K);
  const double scale = dense(K).cwiseAbs().maxCoeff();
  c.fluid.add_reference_tangent(c.x, -1.0, c.slots, K);
  EXPECT_LT(dense(K).cwiseAbs().maxCoeff(), 1e-15 * scale);
}

// The heads of a scene by differences against what head_terms says: column = -df/dh as a load,
// row = dh/dx with the sign such that K gains column row^T.
void check_head_terms(const Mesh& mesh, const Hydrostatics& fluid, const Points& x,
                      std::size_t compartment) {
  const std::vector<double> heads = fluid.heads(x);
  const std::vector<RankOne> terms = fluid.head_terms(x, heads);
  ASSERT_EQ(terms.size(), 1u);
  const Eigen::VectorXd column = flat(terms[0].column), row = flat(terms[0].row);
  // column = df/dh
  const double step = 1e-4;
  std::vector<double> plus = heads, minus = heads;
  for (std::size_t k = 0; k < heads.size(); ++k) {
    if (heads[k] != heads[compartment]) continue;
    plus[k] += step;
    minus[k] -= step;
  }
  const Eigen::VectorXd slope =
      flat(test::force_at(fluid, x, plus) - test::force_at(fluid, x, minus)) / (2.0 * step);
  EXPECT_LT((column - slope).norm(), 1e-6 * slope.norm());
  // row = -dh/dx
  const Dense h = differences(x, 1e-3, [&](const Points& y) {
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, -fluid.heads(y)[compartment]));
  });
  EXPECT_GT(row.norm(), 0.0);
  // heads are solved to 1e-15 of the volume: round-off of h ~1e-13 mm over the step
  EXPECT_LT((row - h.row(0).transpose()).norm(), 1e-5 * row.norm());
  // and together: the total slope of the force with heads solved for
  BlockMatrix K(neighbours(mesh));
  fluid.add_tangent(x, heads, test::all_nodes(mesh), K);
  const Dense total = dense(K) + column * row.transpose();
  const Dense D = differences(x, 1e-3, [&](const Points& y) {
    return Eigen::VectorXd(-flat(test::force_at(fluid, y, fluid.heads(y))));
  });
  EXPECT_LT((total - D).cwiseAbs().maxCoeff(), 1e-5 * D.cwiseAbs().maxCoeff());
}

TEST(FluidTangent, HeadTermsMatchDifferencesForALostVolume) {
  Case c;
  for (double lost : {2e4, 1e5}) {
    c.csf.set_lost_volume(0, lost);
    c.fluid.configure(c.csf, test::gravity_down);
    check_head_terms(c.mesh, c.fluid, c.x, 0);
  }
}

TEST(FluidTangent, HeadTermsOfQuadraticFacesMatchDifferences) {
  const auto flat_difference = [](const Points& a, const Points& b, double step) {
    return Eigen::VectorXd(flat(a - b) / (2.0 * step));
  };
  Case c(true);
  c.csf.set_lost_volume(0, 5e4);
  c.fluid.configure(c.csf, test::gravity_down);
  const std::vector<double> heads = c.fluid.heads(c.x);
  const std::vector<RankOne> terms = c.fluid.head_terms(c.x, heads);
  ASSERT_EQ(terms.size(), 1u);
  const Eigen::VectorXd slope =
      flat_difference(test::force_at(c.fluid, c.x, {heads[0] + 1e-4}),
                      test::force_at(c.fluid, c.x, {heads[0] - 1e-4}), 1e-4);
  EXPECT_LT((flat(terms[0].column) - slope).norm(), 1e-6 * slope.norm());
  const Dense h = differences(c.x, 1e-3, [&](const Points& y) {
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, -c.fluid.heads(y)[0]));
  });
  EXPECT_LT((flat(terms[0].row) - h.row(0).transpose()).norm(), 1e-5 * h.norm());
}

TEST(FluidTangent, HeadTermsMatchDifferencesForAnAirVolume) {
  Case c;
  c.csf.set_air_volume(0, 4e4);
  c.fluid.configure(c.csf, test::gravity_down);
  check_head_terms(c.mesh, c.fluid, c.x, 0);
}

// Two boxes of tissue side by side, each in its own box of the cavity.
struct TwoSides {
  Mesh mesh;
  Csf csf;
  explicit TwoSides(FluidModel model)
      : mesh(make()),
        csf(test::fluid_density, model,
            {test::make_compartment("left", test::box_wall({-14, -2, -2}, {0, 12, 12}),
                                    mesh.faces_of_region(0)),
             test::make_compartment("right", test::box_wall({0, -2, -2}, {14, 12, 12}),
                                    mesh.faces_of_region(1))}) {}
  static Mesh make() {
    const auto left = test::moved(test::make_box({10, 10, 10}, 1, 1, 1), {-11, 0, 0});
    const auto right = test::moved(test::make_box({10, 10, 10}, 1, 1, 1), {1, 0, 0});
    Indices regions(12, 0);
    std::fill(regions.begin() + 6, regions.end(), 1);
    return test::make_mesh(test::joined(left, right), regions);
  }
};

TEST(FluidTangent, HeadTermsMatchDifferencesInTheCommunicatingFluid) {
  TwoSides c(FluidModel::communicating);
  const Points x = test::shaken(c.mesh, 0.7);
  for (bool air : {false, true}) {
    if (air) {
      c.csf.set_air_volume(1, 400.0);
    } else {
      c.csf.set_lost_volume(1, 400.0);
    }
    const Hydrostatics fluid(c.mesh, c.csf, test::gravity_down);
    check_head_terms(c.mesh, fluid, x, 1);
  }
}

TEST(FluidTangent, GivenHeadsHaveNoTerms) {
  TwoSides c(FluidModel::separate);
  c.csf.set_level(0, 3.0);
  const Hydrostatics fluid(c.mesh, c.csf, test::gravity_down);
  EXPECT_TRUE(fluid.head_terms(c.mesh.nodes(), fluid.heads(c.mesh.nodes())).empty());
}

}  // namespace
}  // namespace brainshift
