// Neo-Hookean with logarithms of J (Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element
// Analysis, 2nd edition, section 6.4.3):
//   psi = mu/2 (|F|^2 - 3) - mu ln J + lambda/2 ln^2 J,
//   P   = mu (F - F^-T) + lambda ln J F^-T,     F^-T = cof F / J.
// There is no energy at J <= 0, and as J -> 0+ it grows beyond bounds. There the functions answer
// with +infinity, stress and tangent too, and never with a finite number or NaN of log(J): whoever
// asks for finite ones turns such a state down.
// Everything is expanded in G, where the terms of order 0 and 1 cancel exactly.
#include <cmath>
#include <limits>

#include "material/isotropic_modes.hpp"
#include "material/laws.hpp"
#include "material/mat9.hpp"

namespace brainshift {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// False for NaN, too.
bool has_energy(double change) { return 1.0 + change > 0.0; }

// x - ln(1 + x) >= 0 without cancellation: with r = x / (2 + x), ln(1 + x) = 2 artanh r and
// x - 2 r = x r. Six terms of artanh leave 1e-18 of the result at the end of the interval.
double minus_log(double x) {
  if (std::abs(x) > 0.1) return x - std::log1p(x);
  const double r = x / (2.0 + x), q = r * r;
  const double series =
      1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * (1.0 / 11.0 + q / 13.0))));
  return r * (x - 2.0 * q * series);
}

// (|F|^2 - 3)/2 - ln J = |sym G|^2 - tr^2 G / 2 - det G + [J - 1 - ln J], all of second order in G.
double energy(const Lame& lame, const Mat3& G) {
  const double change = volume_change(G);
  if (!has_energy(change)) return infinity;
  const double trace = G.trace(), log = std::log1p(change);
  const Mat3 strain = 0.5 * (G + G.transpose());
  return lame.mu *
             (strain.squaredNorm() - 0.5 * trace * trace - G.determinant() + minus_log(change)) +
         0.5 * lame.lambda * log * log;
}

// P = [mu (J F - cof F) + lambda ln J cof F] / J, where J F - cof F = G - (cof F - I) + (J - 1) F.
Mat3 stress_with_inverse(const Lame& lame, const Mat3& G, double change, Mat3& inverse) {
  const Mat3 cof_change = cofactor_change(G);
  const Mat3 F = Mat3::Identity() + G;
  const double J = 1.0 + change;
  inverse = (Mat3::Identity() + cof_change) / J;  // F^-T
  return lame.mu / J * (G - cof_change + change * F) + lame.lambda * std::log1p(change) * inverse;
}

Mat3 stress(const Lame& lame, const Mat3& G) {
  const double change = volume_change(G);
  if (!has_energy(change)) return Mat3::Constant(infinity);
  Mat3 inverse;
  return stress_with_inverse(lame, G, change, inverse);
}

// psi_i = mu s_i + c / s_i, c = lambda ln J - mu; 1 / s_i = (dJ/ds_i) / J.
IsotropicModes modes_of(const Lame& lame, const Vec3& strain, double J, double c) {
  const Vec3 s = 1.0 + strain.array();
  const Vec3 inverse = Vec3(s[1] * s[2], s[2] * s[0], s[0] * s[1]) / J;
  IsotropicModes modes;
  modes.scaling = lame.lambda * inverse * inverse.transpose();
  modes.scaling.diagonal().array() += lame.mu - c * inverse.array().square();
  modes.twist = lame.mu + c / J * s.array();
  modes.flip = lame.mu - c / J * s.array();
  return modes;
}

// dP = mu dF + (lambda - c) F^-T (F^-T : dF) + c/J (d cof F / dF) dF
void tangent(const Lame& lame, const Mat3& G, bool definite, Mat3& P, Mat9& A) {
  const double change = volume_change(G);
  if (!has_energy(change)) {
    P.setConstant(infinity);
    A.setConstant(infinity);
    return;
  }
  const double J = 1.0 + change, c = lame.lambda * std::log1p(change) - lame.mu;
  Mat3 inverse;
  P = stress_with_inverse(lame, G, change, inverse);
  const Vec9 f = as_vector(inverse);
  A.noalias() = (lame.lambda - c) * f * f.transpose();
  A.diagonal().array() += lame.mu;
  add_cofactor_derivative(Mat3::Identity() + G, c / J, A);
  if (definite) {
    const Polar polar = polar_decomposition(G);
    remove_negative_modes(polar, modes_of(lame, polar.strain, J, c), A);
  }
}

// ln J
VolumeMeasure volume(const Mat3& G) {
  const double change = volume_change(G), J = 1.0 + change;
  if (!has_energy(change)) {
    return {infinity, Mat3::Constant(infinity), Mat9::Constant(infinity)};
  }
  const Mat3 inverse = (Mat3::Identity() + cofactor_change(G)) / J;  // F^-T
  const Vec9 f = as_vector(inverse);
  VolumeMeasure measure{std::log1p(change), inverse, -f * f.transpose()};
  add_cofactor_derivative(Mat3::Identity() + G, 1.0 / J, measure.hessian);
  return measure;
}

}  // namespace

const LawFunctions log_neo_hookean_law = {energy, stress, one_after_the_other<energy, stress>, tangent, nullptr, volume};

}  // namespace brainshift
