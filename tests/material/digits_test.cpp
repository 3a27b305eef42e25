// Tiny displacement gradients keep their digits: the laws are written in H = F - I. References: the
// textbook formulas in F with long double, good to eps / |H|, where |H| is not too small; and below
// that Hooke's law, of which the odd part of a stress differs by the square of |H|. One double would
// lose eps / |H| in F: 1e-4 of the stress at |H| = 1e-12, all of the energy at 1e-8.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "samples.hpp"

namespace brainshift::test {
namespace {

using Real = long double;
using Wide = Eigen::Matrix<Real, 3, 3>;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double wide_eps = double(std::numeric_limits<Real>::epsilon());

struct Response {
  Real energy;
  Wide stress;
};

// Newton's iteration for the polar factor (Higham 1986); F is near a rotation here.
Wide rotation_of(const Wide& F) {
  Wide R = F;
  for (int i = 0; i < 20; ++i) R = (R + Wide(R.inverse().transpose())) / 2;
  return R;
}

Response textbook(Law law, Real mu, Real lambda, const Wide& F) {
  const Wide I = Wide::Identity(), inverse = F.inverse().transpose(), R = rotation_of(F);
  const Real J = F.determinant(), log = std::log(J);
  switch (law) {
    case Law::linear: {
      const Wide e = (F + F.transpose()) / 2 - I;
      return {mu * e.squaredNorm() + lambda / 2 * e.trace() * e.trace(),
              2 * mu * e + lambda * e.trace() * I};
    }
    case Law::corotational: {
      const Real trace = (R.transpose() * F - I).trace();
      return {mu * (F - R).squaredNorm() + lambda / 2 * trace * trace,
              2 * mu * (F - R) + lambda * trace * R};
    }
    case Law::st_venant_kirchhoff: {
      const Wide E = (F.transpose() * F - I) / 2;
      return {mu * E.squaredNorm() + lambda / 2 * E.trace() * E.trace(),
              F * (2 * mu * E + lambda * E.trace() * I)};
    }
    case Law::stable_neo_hookean:
      return {mu / 2 * (F.squaredNorm() - 3) - mu * (J - 1) + (lambda + mu) / 2 * (J - 1) * (J - 1),
              mu * (F - J * inverse) + (lambda + mu) * (J - 1) * J * inverse};
    case Law::log_neo_hookean:
      return {mu / 2 * (F.squaredNorm() - 3) - mu * log + lambda / 2 * log * log,
              mu * (F - inverse) + lambda * log * inverse};
  }
  return {};
}

Response textbook(const Material& m, const Mat3& H) {
  return textbook(m.law(), m.mu(), m.lambda(), Wide::Identity() + H.cast<Real>());
}

// Directions of size 1: pull, shear, change of volume, anything.
std::vector<Mat3> directions() {
  std::mt19937 generator(4);
  std::vector<Mat3> all{Vec3(1.0, 0.0, 0.0).asDiagonal(), Vec3(1.0, -1.0, 0.0).asDiagonal(),
                        Mat3::Identity()};
  all.push_back(Vec3::UnitX() * Vec3::UnitY().transpose());
  for (int i = 0; i < 20; ++i) all.push_back(random_matrix(generator));
  return all;
}

// Round-off of a few operations on terms of size lambda |H|, in units of the stress 2 mu |H| that
// is left where there is no change of volume.
double few_roundings(const Material& m) { return 10.0 * eps * (1.0 + m.lambda() / m.mu()); }

template <class Check>
void for_all_directions(const Check& check) {
  for (const Law law : all_laws) {
    for (const double poisson : {0.0, 0.45, 0.499}) {
      const Material material(law, 6.0, poisson, 0.0);
      for (const Mat3& D : directions()) check(material, D);
    }
  }
}

TEST(Digits, small_gradients_meet_the_textbook_in_long_double) {
  for_all_directions([](const Material& m, const Mat3& D) {
    for (const double size : {1e-2, 1e-3, 1e-4, 1e-5}) {
      const Mat3 H = size * D;
      const Response expected = textbook(m, H);
      const double stress = double(expected.stress.norm()), energy = double(expected.energy);
      const double few = few_roundings(m), wide = few / eps * wide_eps;
      EXPECT_LE(double((m.stress(H).cast<Real>() - expected.stress).norm()),
                (few + wide / size) * stress)
          << to_string(m.law()) << " " << size;
      EXPECT_NEAR(m.energy(H), energy, (few + wide / (size * size)) * energy)
          << to_string(m.law()) << " " << size;
    }
  });
}

TEST(Digits, tiny_gradients_meet_hookes_law) {
  for_all_directions([](const Material& m, const Mat3& D) {
    const Material hooke(Law::linear, m.young(), m.poisson(), 0.0);
    const double few = few_roundings(m);
    // coefficients of the second and third order, in units of the first: up to lambda / mu times ten
    const double order = 10.0 * (1.0 + m.lambda() / m.mu());
    for (const double size :
         {1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-20}) {
      const Mat3 H = size * D, plus = m.stress(H), minus = m.stress(-H), linear = hooke.stress(H);
      EXPECT_LE((0.5 * (plus - minus) - linear).norm(), (few + order * size * size) * linear.norm())
          << to_string(m.law()) << " " << size;
      EXPECT_LE((plus + minus).norm(), (few + order * size) * linear.norm())
          << to_string(m.law()) << " " << size;
      const double energy = hooke.energy(H);
      EXPECT_NEAR(0.5 * (m.energy(H) + m.energy(-H)), energy, (few + order * size * size) * energy)
          << to_string(m.law()) << " " << size;
    }
  });
}

// Strain of 1e-6 in a body turned by 1e-3: eps * 1e-3 is lost in H, not eps * 1.
TEST(Digits, a_small_turn_costs_digits_only_in_proportion_to_it) {
  std::mt19937 generator(9);
  const double turn = 1e-3, strain = 1e-6;
  for (const Law law : nonlinear_laws) {
    const Material m(law, 6.0, 0.45, 0.0);
    for (int i = 0; i < 20; ++i) {
      const Vec3 axis = random_matrix(generator).col(0).normalized();
      const Mat3 R = Eigen::AngleAxisd(turn, axis).toRotationMatrix(), S = random_matrix(generator);
      const Mat3 H = R - Mat3::Identity() + strain * R * S;
      const Wide expected = textbook(m, H).stress;
      const double few = few_roundings(m), lost = few * turn / strain,
                   wide = few / eps * wide_eps / strain;
      EXPECT_LE(double((m.stress(H).cast<Real>() - expected).norm()),
                (few + lost + wide) * double(expected.norm()))
          << to_string(law);
    }
  }
}

}  // namespace
}  // namespace brainshift::test
