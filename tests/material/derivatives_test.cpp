// Stress is the derivative of energy, tangent that of stress: central differences.
// Step 1e-6 (of entries of order 1): truncation 1e-12, rounding 1e-10, so 1e-6 of the largest entry
// (the bound asked for) cannot be met by accident. The derivatives of a law with logarithms grow
// with powers of 1 / stretch: its step is 1e-5 of the smallest stretch, truncation 1e-10 of the
// entry; the rounding of J, eps / 1e-3 in the flattest sample, becomes 1e-7 of it.
#include <gtest/gtest.h>

#include "material/polar.hpp"
#include "samples.hpp"

namespace brainshift::test {
namespace {

constexpr double tolerance = 1e-6;

double step_at(Law law, const Mat3& G) {
  if (allows_inversion(law)) return 1e-6;
  return 1e-5 * std::min(1.0, 1.0 + polar_decomposition(G).strain.minCoeff());
}

Mat3 moved(const Mat3& G, int entry, double by) {
  Mat3 moved_G = G;
  moved_G.data()[entry] += by;
  return moved_G;
}

TEST(Derivatives, stress_is_the_gradient_of_energy) {
  for (const Law law : all_laws) {
    const Material material(law, 6.0, 0.45, 0.0);
    for (const Sample& sample : samples(law)) {
      const Mat3 P = material.stress(sample.G);
      const double step = step_at(law, sample.G);
      const double scale = std::max(P.cwiseAbs().maxCoeff(), material.young());
      for (int k = 0; k < 9; ++k) {
        const double difference = (material.energy(moved(sample.G, k, step)) -
                                   material.energy(moved(sample.G, k, -step))) /
                                  (2.0 * step);
        EXPECT_NEAR(P.data()[k], difference, tolerance * scale)
            << to_string(law) << " " << sample.name << " " << k;
      }
    }
  }
}

TEST(Derivatives, tangent_is_the_gradient_of_stress) {
  for (const Law law : all_laws) {
    const Material material(law, 6.0, 0.45, 0.0);
    for (const Sample& sample : samples(law)) {
      const Eigen::Matrix<double, 9, 9> A = material.tangent(sample.G);
      const double step = step_at(law, sample.G);
      const double scale = A.cwiseAbs().maxCoeff();
      for (int k = 0; k < 9; ++k) {
        const Mat3 difference = (material.stress(moved(sample.G, k, step)) -
                                 material.stress(moved(sample.G, k, -step))) /
                                (2.0 * step);
        for (int i = 0; i < 9; ++i) {
          EXPECT_NEAR(A(i, k), difference.data()[i], tolerance * scale)
              << to_string(law) << " " << sample.name << " " << i << " " << k;
        }
      }
    }
  }
}

TEST(Derivatives, tangent_is_symmetric) {
  for (const Law law : all_laws) {
    const Material material(law, 6.0, 0.45, 0.0);
    for (const Sample& sample : samples(law)) {
      for (const bool definite : {false, true}) {
        const Eigen::Matrix<double, 9, 9> A = material.tangent(sample.G, definite);
        EXPECT_LE((A - A.transpose()).cwiseAbs().maxCoeff(), 1e-14 * A.cwiseAbs().maxCoeff())
            << to_string(law) << " " << sample.name;
      }
    }
  }
}

}  // namespace
}  // namespace brainshift::test
