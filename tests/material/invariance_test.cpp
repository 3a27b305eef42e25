// Rigid motion, frames, the state of rest.
#include <gtest/gtest.h>

#include "samples.hpp"

namespace brainshift::test {
namespace {

TEST(Invariance, a_rigid_rotation_gives_no_stress) {
  std::mt19937 generator(2);
  for (const Law law : nonlinear_laws) {
    for (const double poisson : {0.0, 0.3, 0.45}) {
      const Material material(law, 6.0, poisson, 0.0);
      for (int i = 0; i < 50; ++i) {
        const Mat3 G = random_rotation(generator) - Mat3::Identity();
        EXPECT_LE(material.stress(G).cwiseAbs().maxCoeff(), 1e-12 * 6.0) << to_string(law);
        // terms of the size of |G|^2 <= 8 cancel, times mu <= 3: a few ulp of 24
        EXPECT_LE(std::abs(material.energy(G)), 2e-14) << to_string(law);
      }
    }
  }
}

TEST(Invariance, half_a_turn_gives_no_stress) {
  const Mat3 G = Vec3(-2.0, -2.0, 0.0).asDiagonal();
  for (const Law law : nonlinear_laws) {
    EXPECT_EQ(Material(law, 6.0, 0.45, 0.0).stress(G).norm(), 0.0) << to_string(law);
  }
}

TEST(Invariance, stress_turns_with_the_body) {
  std::mt19937 generator(5);
  for (const Law law : nonlinear_laws) {
    const Material material(law, 6.0, 0.45, 0.0);
    for (const Sample& sample : samples(law)) {
      const Mat3 Q = random_rotation(generator);
      const Mat3 turned = Q * (Mat3::Identity() + sample.G) - Mat3::Identity();
      const Mat3 P = material.stress(sample.G);
      // F is of size 30 at most, P of third order in it: a few hundred ulp of cancellation
      const double scale = 6.0 + material.stress(sample.G).norm();
      // a law that divides by J has the rounding of J in it, some ten eps of 1, relative to J
      const double J = (Mat3::Identity() + sample.G).determinant();
      const double rounding = allows_inversion(law) ? 1e-12 : 1e-12 + 1e-14 / J;
      EXPECT_LE((material.stress(turned) - Q * P).norm(), rounding * scale)
          << to_string(law) << " " << sample.name;
    }
  }
}

TEST(Invariance, every_law_has_hookes_tangent_at_rest) {
  const auto expected = Material(Law::linear, 6.0, 0.45, 0.0).tangent(Mat3::Zero());
  for (const Law law : nonlinear_laws) {
    const auto A = Material(law, 6.0, 0.45, 0.0).tangent(Mat3::Zero());
    EXPECT_LE((A - expected).cwiseAbs().maxCoeff(), 1e-14 * 20.0) << to_string(law);
  }
}

}  // namespace
}  // namespace brainshift::test
