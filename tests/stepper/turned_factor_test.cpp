// A factor turned with the tissue: exact after a rigid rotation, few iterations after a bend too, none where it is too
// far away; and what Newton's method makes of it.
#include "stepper/turned_factor.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "stepper/equilibrium.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

Scene bar(Index n, double gravity, Law law) {
  Scene scene{test::make_mesh(test::make_box({200.0, 40.0, 40.0}, 5 * n, n, n)),
              {{0, Material(law, 6.0, 0.45, test::tissue_density)}}};
  scene.gravity = {0.0, 0.0, -gravity * standard_gravity};
  scene.balanced_reference = false;
  return scene;
}

void clamp_one_end(Scene& scene) {
  scene.constraints.fix("wall", test::nodes_where(scene.mesh, [](const Vec3& x) { return x.x() == 0.0; }));
}

// Held by springs alike in all directions, which a rotation leaves as they are.
struct Sprung {
  Scene scene;
  Equilibrium balance;
  BlockMatrix K;
  std::unique_ptr<SpdSolver> solver = make_spd_solver();

  explicit Sprung(Law law) : scene(with_springs(law)), balance(scene), K(balance.blocks().make_matrix()) {
    solver->analyse(K);
  }
  static Scene with_springs(Law law) {
    Scene scene = bar(2, 0.0, law);
    Indices all(std::size_t(scene.mesh.node_count()));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = Index(i);
    scene.constraints.support("springs", all, Eigen::VectorXd::Constant(1, 0.5));
    return scene;
  }
  // That of the rest shape; the body must outlive it.
  TurnedFactor factor_at_rest() {
    const Points rest = Points::Zero(scene.mesh.node_count(), 3);
    linearise(rest);
    EXPECT_TRUE(solver->factorise(K));
    TurnedFactor factor(scene.mesh, balance.blocks(), K, *solver);
    factor.take_factor(Reduction(balance.blocks().count(), {}), rest);
    return factor;
  }
  void linearise(const Points& u) { balance.tangent(u, balance.forces(u), {}, false, K); }
  static Mat3 rotation(double angle) {
    return Eigen::AngleAxisd(angle, Vec3(0.3, 1.0, -0.4).normalized()).toRotationMatrix();
  }
  Points turned(double angle) const { return scene.mesh.nodes() * (rotation(angle) - Mat3::Identity()).transpose(); }
};

Eigen::VectorXd force_on(const Sprung& body) {
  const auto size = 3 * Eigen::Index(body.balance.blocks().count());
  return Eigen::VectorXd::NullaryExpr(size, [](Eigen::Index i) { return std::sin(1.0 + double(i * i % 97)); });
}

constexpr double single_precision = 1e-5;   // a hundred roundings; no CG iteration is left to do

TEST(TurnedFactor, IsTheInverseAfterARigidRotation) {
  for (const Law law : {Law::corotational, Law::st_venant_kirchhoff, Law::stable_neo_hookean}) {
    Sprung body(law);
    const Points u = body.turned(2.0);
    const Eigen::VectorXd f = force_on(body);
    TurnedFactor factor = body.factor_at_rest();
    body.linearise(u);
    const auto dx = factor.step({}, u, f);
    ASSERT_TRUE(dx.has_value());
    ASSERT_TRUE(body.solver->factorise(body.K));
    Eigen::MatrixXd exact = f;
    body.solver->solve(exact);
    EXPECT_LT((*dx - exact).norm(), single_precision * exact.norm()) << to_string(law);
  }
}

TEST(TurnedFactor, LeavesATenthOfAStepAfterATurnAndABend) {
  Sprung body(Law::st_venant_kirchhoff);
  Points u = Points::Zero(body.scene.mesh.node_count(), 3);
  const Mat3 R = body.rotation(2.0);
  for (Eigen::Index i = 0; i < u.rows(); ++i) {
    const Vec3 p = body.scene.mesh.nodes().row(i);
    const double radius = 1500.0, angle = p.x() / radius, r = radius + 20.0 - p.z();
    const Vec3 bent(r * std::sin(angle), p.y(), radius + 20.0 - r * std::cos(angle));
    u.row(i) = R * bent - p;
  }
  const Eigen::VectorXd f = force_on(body);
  TurnedFactor factor = body.factor_at_rest();
  body.linearise(u);
  const auto dx = factor.step({}, u, f);
  ASSERT_TRUE(dx.has_value());
  Eigen::VectorXd Kdx;
  body.K.multiply(*dx, Kdx);
  ASSERT_TRUE(body.solver->factorise(body.K));
  Eigen::MatrixXd moved(f.size(), 2);
  moved << f, f - Kdx;
  body.solver->solve(moved);   // near the norm of the preconditioner, of which a hundredth is left
  EXPECT_LT(moved.col(1).dot(f - Kdx), 0.03 * moved.col(0).dot(f));
}

TEST(TurnedFactor, HasNoStepWhereTheTangentIsNotPositive) {
  Sprung body(Law::st_venant_kirchhoff);
  const Points u = -0.6 * body.scene.mesh.nodes();
  TurnedFactor factor = body.factor_at_rest();
  body.linearise(u);   // pressed far beyond the law's limit
  EXPECT_FALSE(factor.step({}, u, force_on(body)).has_value());
}

struct Carried {
  Law law;
  int factorisations;   // at most
};

TEST(TurnedFactor, CarriesABarThatTurnsFarToItsBalance) {
  for (const Carried& c : {Carried{Law::st_venant_kirchhoff, 1}, Carried{Law::corotational, 4}}) {
    Scene scene = bar(4, 0.05, c.law);
    clamp_one_end(scene);
    Stepper stepper(scene);
    const SolveReport report = stepper.solve_static();
    ASSERT_TRUE(report.converged()) << report.message;
    EXPECT_LE(report.residual, 1e-8);
    EXPECT_GT(stepper.displacement().cwiseAbs().maxCoeff(), 60.0) << "the scene does not turn far";
    EXPECT_LE(report.factorisations, c.factorisations) << to_string(c.law);
    EXPECT_LE(report.iterations, 25) << to_string(c.law);
    EXPECT_EQ(report.tangent, Definiteness::not_examined) << "the factor is of another iterate";
  }
}

}  // namespace
}  // namespace brainshift
