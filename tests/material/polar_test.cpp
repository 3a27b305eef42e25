// The polar decomposition never returns a reflection and never NaN.
#include "material/polar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "samples.hpp"

namespace brainshift::test {
namespace {

void expect_valid(const Mat3& G, const std::string& name) {
  const Polar polar = polar_decomposition(G);
  ASSERT_TRUE(polar.R.allFinite() && polar.strain.allFinite()) << name;
  const Mat3 F = Mat3::Identity() + G;
  // orthogonality is lost by eps / 1e-3, the ratio where the sure path takes over
  EXPECT_NEAR(polar.R.determinant(), 1.0, 1e-12) << name;
  EXPECT_LE((polar.R.transpose() * polar.R - Mat3::Identity()).norm(), 1e-12) << name;
  const Vec3 s = 1.0 + polar.strain.array();
  const Mat3 rebuilt = polar.U * s.asDiagonal() * polar.V.transpose();
  EXPECT_LE((rebuilt - F).norm(), 1e-13 * (1.0 + F.norm())) << name;
  const Mat3 S = polar.R.transpose() * F;
  EXPECT_LE((S - S.transpose()).norm(), 1e-12 * (1.0 + F.norm())) << name;
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(s[(k + 1) % 3] + s[(k + 2) % 3], -1e-15 * (1.0 + F.norm())) << name;
  }
}

TEST(Polar, is_a_rotation_and_rebuilds_the_gradient) {
  for (const Sample& sample : samples()) expect_valid(sample.G, sample.name);
}

TEST(Polar, survives_what_has_no_unique_rotation) {
  std::mt19937 generator(7);
  expect_valid(-Mat3::Identity(), "F = 0");
  expect_valid(-2.0 * Mat3::Identity(), "F = -I");
  expect_valid(Vec3(0.0, 0.0, -2.0).asDiagonal(), "mirrored");
  for (int i = 0; i < 20; ++i) {
    expect_valid(with_stretches({1.3, 0.5, -0.5}, generator), "two equal smallest, inverted");
    expect_valid(with_stretches({1.3, 0.0, 0.0}, generator), "line");
    expect_valid(with_stretches({1e-9, 1e-9, -1e-9}, generator), "almost a point");
    expect_valid(with_stretches({1e6, 1.0, 1e-6}, generator), "extreme");
  }
}

void expect_same(const Mat3& G, const std::string& name) {
  const Polar polar = polar_decomposition(G);
  const Stretch found = stretch(G);
  EXPECT_LE((found.R - polar.R).norm(), 1e-11) << name;
  const Mat3 D = polar.V * polar.strain.asDiagonal() * polar.V.transpose();
  EXPECT_LE((found.D - D).norm(), 1e-13 * (G.norm() + D.norm())) << name;
  EXPECT_EQ(found.D, found.D.transpose()) << name;
}

TEST(Polar, the_stretch_alone_is_the_same) {
  for (const Sample& sample : samples()) expect_same(sample.G, sample.name);
  std::mt19937 generator(8);
  for (const Vec3& s : {Vec3(1.0, 1.0, 1.0), Vec3(1.2, 0.9, 0.8), Vec3(3.0, 1.0, 0.3), Vec3(0.2, 0.1, 0.05),
                        Vec3(8.0, 1.0, 0.5), Vec3(1.0, 1.0, 1e-4), Vec3(1.3, 0.9, -0.5)}) {
    for (int i = 0; i < 20; ++i) expect_same(with_stretches(s, generator), "stretched");
  }
}

TEST(Polar, every_law_stays_finite_where_the_rotation_is_not_unique) {
  for (const Law law : all_laws) {
    if (!allows_inversion(law)) continue;
    const Material material(law, 6.0, 0.45, 0.0);
    for (const Mat3& G : {Mat3(-Mat3::Identity()), Mat3(-2.0 * Mat3::Identity()),
                          Mat3(Vec3(0.3, -0.5, -1.5).asDiagonal())}) {
      EXPECT_TRUE(std::isfinite(material.energy(G))) << to_string(law);
      EXPECT_TRUE(material.stress(G).allFinite()) << to_string(law);
      EXPECT_TRUE(material.tangent(G, false).allFinite()) << to_string(law);
      EXPECT_TRUE(material.tangent(G, true).allFinite()) << to_string(law);
    }
  }
}

// A NaN must stay visible: the line search rejects a step by it.
TEST(Polar, passes_nan_and_infinity_on) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Mat3 G = Mat3::Zero();
    G(1, 2) = bad;
    for (const Law law : all_laws) {
      const Material material(law, 6.0, 0.45, 0.0);
      EXPECT_FALSE(std::isfinite(material.energy(G))) << to_string(law);
      EXPECT_FALSE(material.stress(G).allFinite()) << to_string(law);
    }
  }
}

}  // namespace
}  // namespace brainshift::test
