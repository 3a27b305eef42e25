// A balance that is not stable is not passed over in silence. The tangent that the certificate speaks of
// is looked at here by itself, as a dense matrix.
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "robustness/outcome.hpp"
#include "stepper/equilibrium.hpp"

namespace brainshift::test {
namespace {

constexpr double young = 6.0, height = 40.0, head = 10.0;   // kPa, mm

// A bar pressed by a stiff head of such a weight that gravity counts pressure in Young's moduli. No node
// moves sideways, so that strain is uniform: (1 - stretch) (lambda + 2 mu) = pressure by the co-rotational
// law, which at Poisson's ratio 0.45 loses ellipticity at the stretch 0.82 (docs/stability.md).
Scene pressed_bar(Law law, double pressure) {
  const TetShape shape = make_box({20, 20, height + head}, 2, 2, 5);
  Indices regions(std::size_t(shape.tets.rows()), 0);
  std::fill(regions.begin() + 6 * 2 * 2 * 4, regions.end(), 1);
  Scene scene{make_mesh(shape, regions),
              {{0, Material(law, young, 0.45, 0.0)},
               {1, Material(Law::linear, 1e4 * young, 0.3, young / (standard_gravity * head))}},
              {0, 0, -pressure * standard_gravity}};
  scene.balanced_reference = false;
  scene.constraints.fix("base", bottom(scene.mesh), {false, false, true});
  scene.constraints.fix("sides", all_nodes(scene.mesh), {true, true, false});
  return quadratic(scene);
}

constexpr double modulus = young * 0.55 / (1.45 * 0.1);   // lambda + 2 mu

double pressure_at(double stretch) { return (1.0 - stretch) * modulus / young; }

// Smallest eigenvalue of the tangent at u over the largest, of what the fixed nodes leave free.
double smallest_eigenvalue(const Scene& scene, const Points& u) {
  const Equilibrium equilibrium(scene);
  BlockMatrix K = equilibrium.blocks().make_matrix();
  equilibrium.tangent(u, equilibrium.forces(u), {}, false, K);
  std::vector<char> held(std::size_t(3 * K.blocks()), 0);
  for (const NodeRow& row : equilibrium.fixed_rows()) {
    Eigen::Index axis = 0;
    row.normal.cwiseAbs().maxCoeff(&axis);
    held[std::size_t(3 * row.block + axis)] = 1;
  }
  std::vector<int> place(held.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!held[i]) place[i] = count++;
  }
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(count, count);
  for (std::size_t j = 0; j < held.size(); ++j) {
    for (int k = K.scalar_columns()[j]; k < K.scalar_columns()[j + 1]; ++k) {
      const int row = place[std::size_t(K.scalar_rows()[std::size_t(k)])];
      if (row >= 0 && place[j] >= 0) dense(row, place[j]) = K.values()[std::size_t(k)];
    }
  }
  // Reads the lower triangle only, which is what the matrix holds.
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense, Eigen::EigenvaluesOnly).eigenvalues();
  return values[0] / values[count - 1];
}

// Pressed to the stretch in four calls; what the last of them reports.
SolveReport press(Stepper& stepper, double stretch) {
  SolveReport report;
  for (int call = 1; call <= 4; ++call) {
    stepper.set_gravity({0, 0, -0.25 * call * pressure_at(stretch) * standard_gravity});
    report = stepper.solve_static();
    expect_converged(report);
  }
  return report;
}

TEST(StabilityOfBalance, ACorotationalBlockBeyondItsLimitIsReportedAndSaidInASentence) {
  const Scene scene = pressed_bar(Law::corotational, 0.0);
  Stepper stepper(scene);
  const SolveReport report = press(stepper, 0.5);
  EXPECT_LT(smallest_eigenvalue(scene, stepper.displacement()), -1e-6);
  EXPECT_EQ(report.tangent, Definiteness::indefinite) << to_string(report.tangent);
  for (const char* word : {"stable", "positive definite", "ellipticity"})
    EXPECT_NE(report.message.find(word), std::string::npos) << report.message;
}

TEST(StabilityOfBalance, BeforeTheLimitAndForALawWithoutOneNothingIsSaid) {
  struct Case {
    Law law;
    double stretch;
  };
  for (const Case& c : {Case{Law::corotational, 0.9}, Case{Law::stable_neo_hookean, 0.5},
                        Case{Law::linear, 0.5}}) {
    const Scene scene = pressed_bar(c.law, 0.0);
    Stepper stepper(scene);
    const SolveReport report = press(stepper, c.stretch);
    EXPECT_GT(smallest_eigenvalue(scene, stepper.displacement()), 1e-8) << to_string(c.law);
    EXPECT_NE(report.tangent, Definiteness::indefinite) << to_string(c.law);
    EXPECT_EQ(report.message.find("stable"), std::string::npos) << report.message;
  }
}

TEST(StabilityOfBalance, IsNotExaminedWhereNothingIsSolvedNorOfASolveThatFailed) {
  Stepper stepper(pressed_bar(Law::corotational, 0.0));
  SolveReport report = stepper.solve_static();
  expect_converged(report);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.tangent, Definiteness::not_examined);
  Stepper broken(pressed_bar(Law::st_venant_kirchhoff, 2.0));
  report = broken.solve_static();
  EXPECT_EQ(report.status, Status::no_equilibrium);
  EXPECT_EQ(report.tangent, Definiteness::not_examined);
}

}  // namespace
}  // namespace brainshift::test
