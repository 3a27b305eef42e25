// Homogeneous states with known answers: uniaxial stress, simple shear, pressure all round.
// Tabulated numbers were computed independently and are printed to eight decimals: half a unit of
// the last place is the tolerance.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "brainshift/material.hpp"

namespace brainshift::test {
namespace {

constexpr double last_place = 0.51e-8;

// The root in [a, b]; f changes sign once there.
double bisect(const std::function<double(double)>& f, double a, double b) {
  const bool negative_at_a = f(a) < 0.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (a + b);
    ((f(middle) < 0.0) == negative_at_a ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

Mat3 stress(const Material& material, double axial, double lateral) {
  return material.stress(Vec3(axial - 1.0, lateral - 1.0, lateral - 1.0).asDiagonal());
}

struct Uniaxial {
  double poisson, stretch;
  Law law;
  double nominal_stress, lateral_stretch;
};

const Uniaxial uniaxial_table[] = {
    {0.3, 0.5, Law::corotational, -0.5, 1.15},
    {0.45, 0.7, Law::corotational, -0.3, 1.135},
    {0.45, 0.9, Law::corotational, -0.1, 1.045},
    {0.45, 1.3, Law::corotational, 0.3, 0.865},
    {0.499, 0.7, Law::corotational, -0.3, 1.1497},
    {0.3, 0.5, Law::st_venant_kirchhoff, -0.1875, 1.10679718},
    {0.45, 0.7, Law::st_venant_kirchhoff, -0.1785, 1.10882821},
    {0.45, 0.9, Law::st_venant_kirchhoff, -0.0855, 1.04187331},
    {0.45, 1.3, Law::st_venant_kirchhoff, 0.4485, 0.83036137},
    {0.499, 0.7, Law::st_venant_kirchhoff, -0.1785, 1.12004018},
    {0.3, 0.5, Law::stable_neo_hookean, -0.73076923, 1.09544512},
    {0.45, 0.7, Law::stable_neo_hookean, -0.43219061, 1.16933611},
    {0.45, 0.9, Law::stable_neo_hookean, -0.11063810, 1.04822013},
    {0.45, 1.3, Law::stable_neo_hookean, 0.23952726, 0.88712020},
    {0.499, 0.7, Law::stable_neo_hookean, -0.44665345, 1.19471626},
    {0.3, 0.5, Law::log_neo_hookean, -0.93535206, 1.21076739},
    {0.45, 0.7, Law::log_neo_hookean, -0.43393876, 1.17085255},
    {0.45, 0.9, Law::log_neo_hookean, -0.11071290, 1.04831325},
    {0.45, 1.3, Law::log_neo_hookean, 0.23936327, 0.88746858},
    {0.499, 0.7, Law::log_neo_hookean, -0.44665420, 1.19471692},
};

TEST(ClosedForm, uniaxial_stress) {
  for (const Uniaxial& row : uniaxial_table) {
    const Material material(row.law, 1.0, row.poisson, 0.0);
    const double lateral =
        bisect([&](double l) { return stress(material, row.stretch, l)(1, 1); }, 0.6, 1.5);
    EXPECT_NEAR(lateral, row.lateral_stretch, last_place) << to_string(row.law);
    EXPECT_NEAR(stress(material, row.stretch, lateral)(0, 0), row.nominal_stress, last_place)
        << to_string(row.law) << " nu = " << row.poisson << " stretch = " << row.stretch;
  }
}

// P = E (l^3 - l) / 2 has its minimum -E / (3 sqrt 3) at l = 1 / sqrt 3.
TEST(ClosedForm, st_venant_kirchhoff_has_a_limit_point_in_compression) {
  const Material material(Law::st_venant_kirchhoff, 1.0, 0.45, 0.0);
  const auto nominal = [&](double stretch) {
    const double lateral =
        bisect([&](double l) { return stress(material, stretch, l)(1, 1); }, 0.6, 1.5);
    return stress(material, stretch, lateral)(0, 0);
  };
  const double limit = 1.0 / std::sqrt(3.0);
  EXPECT_NEAR(nominal(limit), -1.0 / (3.0 * std::sqrt(3.0)), 1e-12);
  EXPECT_GT(nominal(limit - 0.01), nominal(limit));
  EXPECT_GT(nominal(limit + 0.01), nominal(limit));
}

TEST(ClosedForm, simple_shear_of_st_venant_kirchhoff) {
  const Material material(Law::st_venant_kirchhoff, 6.0, 0.45, 0.0);
  const double mu = material.mu(), lambda = material.lambda();
  for (const double shear : {1e-6, 0.1, 0.7, 2.0}) {
    Mat3 G = Mat3::Zero();
    G(0, 1) = shear;
    const Mat3 P = material.stress(G);
    const double p12 = mu * shear + (lambda / 2.0 + mu) * std::pow(shear, 3);
    const double p11 = lambda * shear * shear / 2.0 + mu * shear * shear;
    EXPECT_NEAR(P(0, 1), p12, 1e-14 * p12 * 10.0);
    EXPECT_NEAR(P(0, 0), p11, 1e-14 * p11 * 10.0);
  }
}

// Stretches (1, 1, l) and (s, s, s), and simple shear (J = 1, F^-T = I - shear e_y e_x^T), by hand.
TEST(ClosedForm, log_neo_hookean_in_confined_stretch_volume_change_and_shear) {
  const Material material(Law::log_neo_hookean, 6.0, 0.45, 0.0);
  const double mu = material.mu(), lambda = material.lambda();
  // The law sees l - 1 and forms J - 1 from it: J is good to some eps of 1.
  const auto rounding = [](double J) { return 1e-14 + 1e-15 / J; };
  for (const double l : {1e-6, 0.01, 0.3, 0.9, 1.5, 20.0}) {
    const double log = std::log(l);
    const double scale = (mu + lambda * (1.0 + std::abs(log))) * (l + 1.0 / l);
    const Mat3 P = stress(material, l, 1.0);
    EXPECT_NEAR(P(0, 0), mu * (l - 1.0 / l) + lambda * log / l, rounding(l) * scale) << l;
    EXPECT_NEAR(P(1, 1), lambda * log, rounding(l) * lambda * (1.0 + std::abs(log))) << l;
    EXPECT_NEAR(material.energy(Vec3(l - 1.0, 0.0, 0.0).asDiagonal()),
                0.5 * mu * (l * l - 1.0) - mu * log + 0.5 * lambda * log * log,
                rounding(l) * (mu + lambda) * (l * l + log * log))
        << l;
  }
  for (const double s : {0.01, 0.3, 0.9, 1.1, 3.0}) {
    const double log = 3.0 * std::log(s), J = s * s * s;
    const double scale = (mu + lambda * (1.0 + std::abs(log))) * (s + 1.0 / s);
    EXPECT_NEAR(stress(material, s, s)(1, 1), mu * (s - 1.0 / s) + lambda * log / s,
                rounding(J) * scale)
        << s;
  }
  for (const double shear : {1e-6, 0.1, 2.0}) {
    Mat3 G = Mat3::Zero(), expected = Mat3::Zero();
    G(0, 1) = shear;
    expected(0, 1) = expected(1, 0) = mu * shear;
    EXPECT_LE((material.stress(G) - expected).norm(), 1e-14 * mu * shear);
  }
}

// The barrier: energy and stress grow beyond bounds as the volume vanishes, and stay infinite.
TEST(ClosedForm, log_neo_hookean_never_lets_the_volume_vanish) {
  const Material material(Law::log_neo_hookean, 6.0, 0.45, 0.0);
  double energy = 0.0, pressure = 0.0;
  for (const double l : {0.5, 0.1, 1e-3, 1e-6, 1e-12, 1e-15}) {
    const Mat3 G = Vec3(0.0, 0.0, l - 1.0).asDiagonal();
    EXPECT_GT(material.energy(G), energy) << l;
    EXPECT_GT(-material.stress(G)(2, 2), pressure) << l;
    EXPECT_TRUE(std::isfinite(material.energy(G)) && material.stress(G).allFinite()) << l;
    EXPECT_TRUE(material.tangent(G, true).allFinite()) << l;
    energy = material.energy(G);
    pressure = -material.stress(G)(2, 2);
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const Mat3& G : {Mat3(Vec3(0.0, 0.0, -1.0).asDiagonal()), Mat3(-Mat3::Identity()),
                        Mat3(Vec3(0.1, -0.2, -1.5).asDiagonal()), Mat3(-2.0 * Mat3::Identity())}) {
    EXPECT_EQ(material.energy(G), infinity);
    EXPECT_TRUE((material.stress(G).array() == infinity).all());
    for (const bool definite : {false, true}) {
      EXPECT_TRUE((material.tangent(G, definite).array() == infinity).all());
    }
  }
}

// A pressure p that follows the surface: P = -p s^2 on the rest area. nu = 0.45, p = 0.1 K.
TEST(ClosedForm, follower_pressure_all_round) {
  const std::pair<Law, double> table[] = {{Law::st_venant_kirchhoff, 0.96722207},
                                          {Law::corotational, 0.96871942},
                                          {Law::stable_neo_hookean, 0.96539973},
                                          {Law::log_neo_hookean, 0.96997687}};
  for (const auto& [law, expected] : table) {
    const Material material(law, 6.0, 0.45, 0.0);
    const double p = 0.1 * material.bulk();
    const double stretch =
        bisect([&](double s) { return stress(material, s, s)(0, 0) + p * s * s; }, 0.9, 1.0);
    EXPECT_NEAR(stretch, expected, last_place) << to_string(law);
  }
}

// The linear law knows no area change: P = -p, s = 1 - p / 3K.
TEST(ClosedForm, pressure_all_round_on_the_linear_law) {
  const Material material(Law::linear, 6.0, 0.45, 0.0);
  EXPECT_NEAR(stress(material, 0.96666667, 0.96666667)(0, 0), -0.1 * material.bulk(),
              3.0 * material.bulk() * last_place);
}

}  // namespace
}  // namespace brainshift::test
