// Stable neo-Hookean (Smith, de Goes, Kim 2018, "Stable neo-Hookean flesh simulation") without its
// log term, lambda_S = lambda + mu:
//   psi = mu/2 (|F|^2 - 3) - mu (J - 1) + (lambda + mu)/2 (J - 1)^2,
//   P   = mu (F - cof F) + (lambda + mu) (J - 1) cof F.
// Smooth everywhere, also at J <= 0. Everything is expanded in G, where the terms of order 0 and 1
// cancel exactly instead of in floating point.
#include "material/isotropic_modes.hpp"
#include "material/laws.hpp"
#include "material/mat9.hpp"

namespace brainshift {
namespace {

double energy(const Lame& lame, const Mat3& G) {
  const double change = volume_change(G);
  return lame.mu * (0.5 * G.squaredNorm() - second_invariant(G) - G.determinant()) +
         0.5 * (lame.lambda + lame.mu) * change * change;
}

Mat3 stress_with_cofactor(const Lame& lame, const Mat3& G, double change, Mat3& cof) {
  const Mat3 cof_minus_one = cofactor_change(G);
  cof = Mat3::Identity() + cof_minus_one;
  return lame.mu * (G - cof_minus_one) + (lame.lambda + lame.mu) * change * cof;
}

Mat3 stress(const Lame& lame, const Mat3& G) {
  Mat3 cof;
  return stress_with_cofactor(lame, G, volume_change(G), cof);
}

// psi_i = mu s_i + c s_j s_k; c = (lambda + mu)(J - 1) - mu
IsotropicModes modes_of(const Lame& lame, const Vec3& strain, double c) {
  const Vec3 s = 1.0 + strain.array();
  const Vec3 g(s[1] * s[2], s[2] * s[0], s[0] * s[1]);  // dJ/ds
  IsotropicModes modes;
  modes.scaling = (lame.lambda + lame.mu) * g * g.transpose();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    modes.scaling(k, k) += lame.mu;
    modes.scaling(i, j) += c * s[k];
    modes.scaling(j, i) += c * s[k];
  }
  modes.twist = lame.mu + c * s.array();
  modes.flip = lame.mu - c * s.array();
  return modes;
}

void tangent(const Lame& lame, const Mat3& G, bool definite, Mat3& P, Mat9& A) {
  const double change = volume_change(G);
  Mat3 cof;
  P = stress_with_cofactor(lame, G, change, cof);
  const Vec9 g = as_vector(cof);
  const double c = (lame.lambda + lame.mu) * change - lame.mu;
  A.noalias() = (lame.lambda + lame.mu) * g * g.transpose();
  A.diagonal().array() += lame.mu;
  add_cofactor_derivative(Mat3::Identity() + G, c, A);
  if (definite) {
    const Polar polar = polar_decomposition(G);
    remove_negative_modes(polar, modes_of(lame, polar.strain, c), A);
  }
}

// J - 1
VolumeMeasure volume(const Mat3& G) {
  VolumeMeasure measure{volume_change(G), Mat3::Identity() + cofactor_change(G), Mat9::Zero()};
  add_cofactor_derivative(Mat3::Identity() + G, 1.0, measure.hessian);
  return measure;
}

}  // namespace

const LawFunctions stable_neo_hookean_law = {energy, stress, one_after_the_other<energy, stress>, tangent, nullptr, volume};

}  // namespace brainshift
