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

constexpr double smallest_pivot = 0.1;   // of tr(S) I - S, which is 2 I at rest

// dR = B M^-1 B^T dF, M = tr(S) I - S, the columns of B R skew(e_k): M = L D L^T gives modes without
// eigenvectors. False: M is not well positive.
bool twists_by_elimination(const Stretch& s, ModalTangent& A) {
  const Mat3& D = s.D;
  const double whole = 2.0 + D.trace();
  const double d0 = whole - D(0, 0);
  if (!(d0 > smallest_pivot)) return false;
  const double l1 = -D(1, 0) / d0, l2 = -D(2, 0) / d0;
  const double d1 = whole - D(1, 1) - l1 * l1 * d0;
  if (!(d1 > smallest_pivot)) return false;
  const double l21 = (-D(2, 1) - l2 * l1 * d0) / d1;
  const double d2 = whole - D(2, 2) - l2 * l2 * d0 - l21 * l21 * d1;
  if (!(d2 > smallest_pivot)) return false;
  A.weight = {0.0, 1.0 / d0, 1.0 / d1, 1.0 / d2};
  A.mode = {s.R, s.R * skew(Vec3(1.0, 0.0, 0.0)), s.R * skew(Vec3(-l1, 1.0, 0.0)),
            s.R * skew(Vec3(l1 * l21 - l2, -l21, 1.0))};   // columns of L^-T
  return true;
}

void twists_by_axes(const Polar& polar, ModalTangent& A) {
  A.mode[0] = polar.R;
  for (int k = 0; k < 3; ++k) {
    const double sum = 2.0 + polar.strain[(k + 1) % 3] + polar.strain[(k + 2) % 3];
    A.weight[std::size_t(k + 1)] = 1.0 / std::max(sum, smallest_stretch_sum);
    A.mode[std::size_t(k + 1)] = polar.R * skew(polar.V.col(k));   // sqrt 2 t_k, up to its sign
  }
}

// Elimination knows no eigenvalues, which a tangent made definite stands on.
void modal_tangent(const Lame& lame, const Mat3& G, bool definite, ModalTangent& A) {
  A.diagonal = 2.0 * lame.mu;
  const Stretch s = definite ? Stretch() : stretch(G);
  double strain = 0.0;   // tr(S - I)
  if (!definite && twists_by_elimination(s, A)) {
    strain = s.D.trace();
  } else {
    const Polar polar = polar_decomposition(G);
    strain = polar.strain.sum();
    twists_by_axes(polar, A);
  }
  A.weight[0] = lame.lambda;
  for (std::size_t k = 1; k < A.weight.size(); ++k) {
    A.weight[k] *= lame.lambda * strain - 2.0 * lame.mu;
    if (definite) A.weight[k] = std::max(A.weight[k], -lame.mu);   // 2 mu + 2 weight, the eigenvalue on t_k, >= 0
  }
}

void tangent(const Lame& lame, const Mat3& G, bool definite, Mat3& P, Mat9& A) {
  P = stress(lame, G);
  ModalTangent modes;
  modal_tangent(lame, G, definite, modes);
  A = modes.diagonal * Mat9::Identity();
  for (std::size_t k = 0; k < modes.mode.size(); ++k) {
    const Vec9 t = as_vector(modes.mode[k]);
    A.noalias() += modes.weight[k] * t * t.transpose();
  }
}

// tr(S - I); its gradient is R.
VolumeMeasure volume(const Mat3& G) {
  const Polar polar = polar_decomposition(G);
  VolumeMeasure measure{polar.strain.sum(), polar.R, Mat9::Zero()};
  ModalTangent modes;
  twists_by_axes(polar, modes);
  for (std::size_t k = 1; k < modes.mode.size(); ++k) {
    const Vec9 t = as_vector(modes.mode[k]);
    measure.hessian.noalias() += modes.weight[k] * t * t.transpose();
  }
  return measure;
}

}  // namespace

const LawFunctions corotational_law = {energy, stress, energy_and_stress, tangent, modal_tangent, volume};

}  // namespace brainshift
