// The co-rotational law as an energy: psi = mu |F - R|^2 + lambda/2 tr^2(R^T F - I), F = R S.
//
//   P  = R (2 mu (S - I) + lambda tr(S - I) I)
//   dP = 2 mu dF + lambda R (R : dF) + (lambda tr(S - I) - 2 mu) dR
// R changes by the three twists of the singular frame only: dR = sum_k 2/(s_i + s_j) t_k (t_k :
// dF), t_k = U skew(e_k) V^T / sqrt 2. R and the t_k are orthogonal, so the eigenvalues of the
// tangent are 2 mu + 3 lambda = 3 K (on R), 2 mu (five of them), and 2 mu + c_k on the twists.
// docs/theory.md (4).
#include <algorithm>

#include "material/laws.hpp"
#include "material/mat9.hpp"
#include "material/polar.hpp"

namespace brainshift {
namespace {

// Where s_i + s_j vanishes R is not defined uniquely and the energy has a ridge. The tangent there
// has a limit of minus infinity; any bounded stand-in serves, as definite = true removes it.
constexpr double smallest_stretch_sum = 1e-6;

Mat3 stress_from(const Lame& lame, const Polar& polar) {
  const Vec3 principal = 2.0 * lame.mu * polar.strain.array() + lame.lambda * polar.strain.sum();
  return polar.U * principal.asDiagonal() * polar.V.transpose();
}

double energy_of(const Lame& lame, const Mat3& D) {
  const double trace = D.trace();
  return lame.mu * D.squaredNorm() + 0.5 * lame.lambda * trace * trace;
}

double energy(const Lame& lame, const Mat3& G) { return energy_of(lame, stretch(G).D); }

double energy_and_stress(const Lame& lame, const Mat3& G, Mat3& P) {
  const Stretch s = stretch(G);
  Mat3 principal = 2.0 * lame.mu * s.D;
  principal.diagonal().array() += lame.lambda * s.D.trace();
  P = s.R * principal;
  return energy_of(lame, s.D);
}

Mat3 stress(const Lame& lame, const Mat3& G) {
  Mat3 P;
  energy_and_stress(lame, G, P);
  return P;
}

void tangent(const Lame& lame, const Mat3& G, bool definite, Mat3& P, Mat9& A) {
  const Polar polar = polar_decomposition(G);
  P = stress_from(lame, polar);

  const Vec9 r = as_vector(polar.R);
  A.noalias() = lame.lambda * r * r.transpose();
  A.diagonal().array() += 2.0 * lame.mu;
  const double weight = lame.lambda * polar.strain.sum() - 2.0 * lame.mu;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double sum = std::max(2.0 + polar.strain[i] + polar.strain[j], smallest_stretch_sum);
    double twist = 2.0 * weight / sum;
    if (definite) twist = std::max(twist, -2.0 * lame.mu);
    const Mat3 mode = polar.R * skew(polar.V.col(k));  // sqrt 2 t_k, up to its sign
    const Vec9 t = as_vector(mode);
    A.noalias() += (0.5 * twist) * t * t.transpose();
  }
}

// tr(S - I); its gradient is R.
VolumeMeasure volume(const Mat3& G) {
  const Polar polar = polar_decomposition(G);
  VolumeMeasure measure{polar.strain.sum(), polar.R, Mat9::Zero()};
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double sum = std::max(2.0 + polar.strain[i] + polar.strain[j], smallest_stretch_sum);
    const Mat3 mode = polar.R * skew(polar.V.col(k));
    const Vec9 t = as_vector(mode);
    measure.hessian.noalias() += (1.0 / sum) * t * t.transpose();
  }
  return measure;
}

}  // namespace

const LawFunctions corotational_law = {energy, stress, energy_and_stress, tangent, volume};

}  // namespace brainshift
