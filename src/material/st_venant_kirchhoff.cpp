// St. Venant-Kirchhoff: psi = mu |E|^2 + lambda/2 tr^2 E with Green's strain E; P = F S,
// S = lambda tr(E) I + 2 mu E. It weakens in compression: limit point at stretch 1/sqrt(3).
#include "material/isotropic_modes.hpp"
#include "material/laws.hpp"
#include "material/mat9.hpp"

namespace brainshift {
namespace {

Mat3 second_stress(const Lame& lame, const Mat3& E) {
  Mat3 S = 2.0 * lame.mu * E;
  S.diagonal().array() += lame.lambda * E.trace();
  return S;
}

double energy(const Lame& lame, const Mat3& G) {
  const Mat3 E = green_strain(G);
  const double trace = E.trace();
  return lame.mu * E.squaredNorm() + 0.5 * lame.lambda * trace * trace;
}

Mat3 stress(const Lame& lame, const Mat3& G) {
  const Mat3 S = second_stress(lame, green_strain(G));
  return S + G * S;
}

// psi = sum_i mu e_i^2 + lambda/2 (sum e_i)^2 with e_i = (s_i^2 - 1)/2; the quotients of
// isotropic_modes.hpp divide out.
IsotropicModes modes_of(const Lame& lame, const Vec3& strain) {
  const Vec3 s = 1.0 + strain.array();
  const double trace = 0.5 * (strain.array() * (2.0 + strain.array())).sum();
  const double base = lame.lambda * trace - lame.mu;
  IsotropicModes modes;
  modes.scaling = lame.lambda * s * s.transpose();
  for (int k = 0; k < 3; ++k) {
    const double a = s[(k + 1) % 3], b = s[(k + 2) % 3];
    modes.scaling(k, k) += base + 3.0 * lame.mu * s[k] * s[k];
    modes.twist[k] = base + lame.mu * (a * a - a * b + b * b);
    modes.flip[k] = base + lame.mu * (a * a + a * b + b * b);
  }
  return modes;
}

// dP = dF S + F (lambda (F : dF) I + mu (F^T dF + dF^T F)), block (j, l) of columns j of P, l of F
void tangent(const Lame& lame, const Mat3& G, bool definite, Mat3& P, Mat9& A) {
  const Mat3 S = second_stress(lame, green_strain(G));
  P = S + G * S;
  const Mat3 F = Mat3::Identity() + G;
  const Mat3 B = lame.mu * F * F.transpose();
  for (int l = 0; l < 3; ++l) {
    for (int j = 0; j < 3; ++j) {
      auto block = A.block<3, 3>(3 * j, 3 * l);
      block =
          lame.lambda * F.col(j) * F.col(l).transpose() + lame.mu * F.col(l) * F.col(j).transpose();
      block.diagonal().array() += S(j, l);
      if (j == l) block += B;
    }
  }
  if (definite) {
    const Polar polar = polar_decomposition(G);
    remove_negative_modes(polar, modes_of(lame, polar.strain), A);
  }
}

// tr E
VolumeMeasure volume(const Mat3& G) {
  return {G.trace() + 0.5 * G.squaredNorm(), Mat3::Identity() + G, Mat9::Identity()};
}

}  // namespace

const LawFunctions st_venant_kirchhoff_law = {energy, stress, one_after_the_other<energy, stress>, tangent, nullptr, volume};

}  // namespace brainshift
