// tangent(G, definite = true) is the nearest positive semidefinite matrix.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "samples.hpp"

namespace brainshift::test {
namespace {

using Mat9 = Eigen::Matrix<double, 9, 9>;

// The eigenvalue clamp by a general solver: the independent method.
Mat9 clamped(const Mat9& A) {
  const Eigen::SelfAdjointEigenSolver<Mat9> eigen(0.5 * (A + A.transpose()));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

TEST(Projection, has_no_negative_eigenvalue) {
  for (const Law law : all_laws) {
    const Material material(law, 6.0, 0.45, 0.0);
    for (const Sample& sample : samples(law)) {
      const Mat9 A = material.tangent(sample.G, true);
      const Eigen::SelfAdjointEigenSolver<Mat9> eigen(A, Eigen::EigenvaluesOnly);
      // round-off of a 9 x 9 eigenvalue solve
      EXPECT_GE(eigen.eigenvalues()[0], -1e-12 * A.cwiseAbs().maxCoeff())
          << to_string(law) << " " << sample.name;
    }
  }
}

TEST(Projection, agrees_with_a_general_eigenvalue_clamp) {
  for (const Law law : all_laws) {
    const Material material(law, 6.0, 0.45, 0.0);
    for (const Sample& sample : samples(law)) {
      const Mat9 A = material.tangent(sample.G, false);
      const double error = (material.tangent(sample.G, true) - clamped(A)).cwiseAbs().maxCoeff();
      EXPECT_LE(error, 1e-12 * A.cwiseAbs().maxCoeff()) << to_string(law) << " " << sample.name;
    }
  }
}

// Stretches of 1/20 to 20 in any frame, and one of them negative where the law allows inversion: the
// lowest eigenvalue, the clamp, and no change where there is nothing to clamp.
TEST(Projection, holds_for_random_deformations) {
  std::mt19937 generator(6);
  std::uniform_real_distribution<double> exponent(-std::log(20.0), std::log(20.0));
  for (const Law law : all_laws) {
    int clamps = 0, definite = 0;
    for (const double poisson : {-0.5, 0.0, 0.3, 0.45, 0.499}) {
      const Material material(law, 6.0, poisson, 0.0);
      for (int i = 0; i < 200; ++i) {
        Vec3 s;
        for (int k = 0; k < 3; ++k) s[k] = std::exp(exponent(generator));
        if (i % 2 == 1 && allows_inversion(law)) s[i % 3] *= -1.0;
        const Mat3 G = with_stretches(s, generator);
        const Mat9 A = material.tangent(G, false), projected = material.tangent(G, true);
        const double scale = A.cwiseAbs().maxCoeff();
        const Eigen::SelfAdjointEigenSolver<Mat9> before(A, Eigen::EigenvaluesOnly),
            after(projected, Eigen::EigenvaluesOnly);
        // 1 / 400 of stretches costs the frame some 1e3 eps
        ASSERT_GE(after.eigenvalues()[0], -1e-12 * scale) << to_string(law) << " " << s.transpose();
        ASSERT_LE((projected - clamped(A)).cwiseAbs().maxCoeff(), 1e-11 * scale)
            << to_string(law) << " " << s.transpose();
        if (before.eigenvalues()[0] > 1e-12 * scale) {
          ASSERT_LE((projected - A).cwiseAbs().maxCoeff(), 1e-12 * scale) << to_string(law) << " " << s.transpose();
          ++definite;
        } else {
          ++clamps;
        }
      }
    }
    if (law == Law::linear) continue;  // semidefinite everywhere, three rotations cost nothing
    EXPECT_GT(clamps, 100) << to_string(law);
    EXPECT_GT(definite, 20) << to_string(law);
  }
}

constexpr double rounding = 1e-14;   // two ways to the same tangent

TEST(Projection, changes_nothing_where_the_tangent_is_definite) {
  std::mt19937 generator(3);
  for (const Law law : nonlinear_laws) {
    const Material material(law, 6.0, 0.3, 0.0);
    for (int i = 0; i < 20; ++i) {
      const Mat3 G = with_stretches({1.1, 1.05, 1.02}, generator);  // mild tension
      const Mat9 A = material.tangent(G, false);
      ASSERT_EQ(Eigen::LLT<Mat9>(A).info(), Eigen::Success) << to_string(law);
      EXPECT_LE((material.tangent(G, true) - A).norm(), rounding * A.norm()) << to_string(law);
    }
  }
}

TEST(Projection, acts_where_compression_makes_the_tangent_indefinite) {
  for (const Law law : nonlinear_laws) {
    const Material material(law, 6.0, 0.45, 0.0);
    const Mat3 G = -0.2 * Mat3::Identity();
    EXPECT_GT((material.tangent(G, false) - material.tangent(G, true)).norm(), 0.1)
        << to_string(law);
  }
}

}  // namespace
}  // namespace brainshift::test
