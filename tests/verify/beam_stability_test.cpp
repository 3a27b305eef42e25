// Critical loads and frequencies: eigenvalues of the exact tangent.
#include <cstdio>
#include <functional>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "support/beams.hpp"

namespace brainshift::test {
namespace {

constexpr double EI = 1.0, L = 1.0;
// Axial strain at the critical load 4 pi^2 EI/(EA L^2) = 4e-8: far below the tolerances.
constexpr double axial = 1e9;

bool stable(const Beam& beam, const BeamState& state, const std::vector<Index>& fixed) {
  Eigen::VectorXd gradient;
  BlockTridiagonal K;
  beam.tangent(state, gradient, K);
  for (const Index dof : fixed) K.fix(dof);
  BlockTridiagonalFactor factor;
  return factor.factorise(K) && factor.positive();
}

// Smallest factor of the load at which the state loses stability.
double critical(double low, double high, const std::function<bool(double)>& stable_at) {
  EXPECT_TRUE(stable_at(low));
  EXPECT_FALSE(stable_at(high));
  while (high - low > 1e-10 * high) {
    const double middle = 0.5 * (low + high);
    (stable_at(middle) ? low : high) = middle;
  }
  return low;
}

// Straight beam pressed to the strain -P/EA.
BeamState pressed(const Beam& beam, double P) {
  BeamState state = beam.rest();
  state.x.col(0) *= 1.0 - P / axial;
  return state;
}

TEST(BeamStability, EulerLoads) {
  const struct {
    const char* name;
    std::vector<Index> near, far;  // fixed dofs at either end
    double load;
    Index coarsest;  // fewer where the errors of more would be those of the axial strain
  } rows[] = {{"cantilever", {0, 1, 2, 3, 4, 5}, {}, 0.25 * pi * pi, 1},
              {"pinned", {0, 1, 2, 3}, {1, 2}, pi * pi, 2},
              {"clamped-pinned", {0, 1, 2, 3, 4, 5}, {1, 2}, 20.1907285564, 4},
              {"clamped-clamped", {0, 1, 2, 3, 4, 5}, {1, 2, 3, 4, 5}, 4.0 * pi * pi, 4}};
  for (const auto& row : rows) {
    const auto error_of = [&](Index elements) {
      const Beam beam = straight_beam(L, elements, round_section(EI, axial));
      std::vector<Index> fixed = row.near;
      for (const Index dof : row.far) fixed.push_back(6 * beam.element_count() + dof);
      const double found = critical(0.1 * row.load, 2.0 * row.load, [&](double P) {
        return stable(beam, pressed(beam, P), fixed);
      });
      return std::abs(found / row.load - 1.0);
    };
    const Convergence found = convergence(four_meshes(row.coarsest), error_of);
    found.print(std::string("Euler load, ") + row.name);
    EXPECT_NEAR(found.observed_order(), 4.0, order_tolerance) << row.name;  // cubic deflection
    EXPECT_LT(error_of(8), 5e-3) << row.name;                               // the bound asked for
  }
}

// Twisted by an angle between a clamp and an end that turns and slides along the axis only: the
// smallest root of tan(T/2) = T/2, Greenhill's problem (1883) with these ends.
TEST(BeamStability, TorsionalBuckling) {
  const double exact = 8.98681891582;  // T L/EI
  EXPECT_NEAR(std::tan(0.5 * exact), 0.5 * exact, 1e-9);
  const Convergence found = convergence(four_meshes(8), [&](Index last) {
    const Beam beam = straight_beam(L, last, round_section(EI, axial));
    const auto fixed = joined(dofs_of(0), dofs_of(last, {1, 2, 3, 4, 5}));
    const double torque = critical(0.1 * exact, 2.0 * exact, [&](double at) {
      BeamState state = beam.rest();
      Eigen::VectorXd twist = Eigen::VectorXd::Zero(beam.dof_count());
      for (Index i = 0; i <= last; ++i) twist[6 * i + 3] = at / EI * i / last;  // GJ = EI
      beam.update(state, twist);
      return stable(beam, state, fixed);
    });
    return std::abs(torque / exact - 1.0);
  });
  found.print("torsional buckling");
  EXPECT_NEAR(found.observed_order(), 4.0, order_tolerance);
  EXPECT_LT(found.error.front(), 5e-3);
}

// A mast under its own weight q per length: q L^3/EI = 7.837347.
TEST(BeamStability, SelfWeightColumn) {
  const double exact = 7.83734743894;
  const Convergence found = convergence(four_meshes(8), [&](Index elements) {
    BeamSection section = round_section(EI, axial);
    section.line_density = 1.0;
    const Beam beam = straight_beam(L, elements, section);
    const double q = critical(0.1 * exact, 2.0 * exact, [&](double at) {
      BeamState state = beam.rest();
      const Eigen::VectorXd weight = beam.weight(Vec3(-at, 0, 0));
      double force = weight.sum();  // on the element, from what lies above it
      for (Index i = 0; i < beam.element_count(); ++i) {
        force -= weight[6 * i];
        state.x(i + 1, 0) = state.x(i, 0) + beam.element(i).length() * (1.0 + force / axial);
      }
      return stable(beam, state, dofs_of(0));
    });
    return std::abs(q / exact - 1.0);
  });
  found.print("self-weight column");
  EXPECT_NEAR(found.observed_order(), 2.0, order_tolerance);  // weight in lumps on the nodes
  EXPECT_LT(found.error[1], 5e-3);
}

enum class Mass { consistent, lumped };

// Rows and columns of `dofs`.
Eigen::MatrixXd part_of(const Eigen::MatrixXd& A, const std::vector<Index>& rows,
                        const std::vector<Index>& columns) {
  Eigen::MatrixXd part(rows.size(), columns.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      part(Eigen::Index(i), Eigen::Index(j)) = A(rows[i], columns[j]);
    }
  }
  return part;
}

// Bending frequencies in the plane (x, y), beta L with (beta L)^4 = omega^2 m L^4/EI. Lumped: the
// masses on the nodes that steps in time use; the rotations have none and are eliminated.
double beta(const Beam& beam, const std::vector<Index>& fixed, Mass mass, int mode) {
  Eigen::VectorXd gradient;
  BlockTridiagonal K;
  beam.tangent(beam.rest(), gradient, K);
  const Eigen::MatrixXd stiffness = K.dense();
  std::vector<Index> moving, spinning;
  for (Index i = 0; i < beam.node_count(); ++i) {
    for (const Index dof : {6 * i + 1, 6 * i + 5}) {
      if (std::find(fixed.begin(), fixed.end(), dof) != fixed.end()) continue;
      (dof % 6 == 5 && mass == Mass::lumped ? spinning : moving).push_back(dof);
    }
  }
  Eigen::MatrixXd k = part_of(stiffness, moving, moving), m;
  if (mass == Mass::consistent) {
    m = part_of(beam.mass(beam.rest()).dense(), moving, moving);
  } else {
    const Eigen::MatrixXd coupled = part_of(stiffness, spinning, moving);
    k -= coupled.transpose() * part_of(stiffness, spinning, spinning).ldlt().solve(coupled);
    Eigen::VectorXd masses(moving.size());
    for (std::size_t i = 0; i < moving.size(); ++i) {
      masses[Eigen::Index(i)] = beam.node_masses()[moving[i] / 6];
    }
    m = masses.asDiagonal();
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, m);
  return std::pow(solver.eigenvalues()[mode], 0.25);
}

// Roots of cos b cosh b = -1 (clamped-free) and 1 (clamped-clamped).
const struct {
  bool clamped_end;
  int mode;
  double beta;
  Index
      coarsest;  // with the consistent mass: below 1e-9 the errors are rounding of the eigenvalues
} frequencies[] = {{false, 0, 1.875104068712, 2},
                   {false, 1, 4.694091132974, 4},
                   {false, 2, 7.854757438238, 4},
                   {true, 0, 4.730040744863, 4}};

Convergence frequency_error(bool clamped_end, Mass mass, int mode, double exact, Index coarsest) {
  BeamSection section = round_section(EI, axial);
  section.line_density = 1.0;
  section.radius = 1e-4;  // rotary inertia: (beta r/L)^2/8, below every tolerance
  return convergence(four_meshes(coarsest), [&](Index elements) {
    const Beam beam = straight_beam(L, elements, section);
    auto fixed = dofs_of(0);
    if (clamped_end) fixed = joined(fixed, dofs_of(elements));
    return std::abs(beta(beam, fixed, mass, mode) / exact - 1.0);
  });
}

TEST(BeamFrequencies, ConsistentMass) {
  for (const auto& row : frequencies) {
    const double end = row.clamped_end ? 1.0 : -1.0;
    // the slope of the left side is about b cosh b: twelve digits of the root
    EXPECT_NEAR(std::cos(row.beta) * std::cosh(row.beta), end,
                2e-12 * row.beta * std::cosh(row.beta));
    const Convergence found =
        frequency_error(row.clamped_end, Mass::consistent, row.mode, row.beta, row.coarsest);
    found.print("consistent mass, beta L " + std::to_string(row.beta));
    EXPECT_NEAR(found.observed_order(), 4.0, order_tolerance) << row.beta;  // cubic deflection
    // a wave of this number spans 8 pi/beta elements; (beta/8)^4/720 each
    EXPECT_LT(found.error.back(),
              2.75 * std::pow(row.beta / found.elements.back(), 4) / 720.0 + 1e-9);
  }
}

TEST(BeamFrequencies, LumpedMassOfStepsInTime) {
  for (const auto& row : frequencies) {
    const Convergence found = frequency_error(row.clamped_end, Mass::lumped, row.mode, row.beta, 8);
    found.print("lumped mass, beta L " + std::to_string(row.beta));
    // Lumping is the trapezoidal rule for the square of the mode, whose first error is that of the
    // slopes at the ends (Euler and Maclaurin): none where both are clamped.
    EXPECT_NEAR(found.observed_order(), row.clamped_end ? 4.0 : 2.0, order_tolerance) << row.beta;
    EXPECT_LT(found.error.back(), 5e-3) << row.beta;
  }
}

}  // namespace
}  // namespace brainshift::test
