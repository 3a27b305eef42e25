// The nearest positive semidefinite tangent of an isotropic law, analytically.
//
// In the singular frame F = U diag(s) V^T the tangent of every isotropic energy psi(s) falls apart
// into one 3 x 3 block (scaling) and six single modes (Smith, de Goes, Kim 2019, "Analytic
// eigensystems for isotropic distortion energies"): for the pair (i, j) and the third index k
//   twist_k = (psi_i + psi_j) / (s_i + s_j)   on  U (e_i e_j^T - e_j e_i^T) V^T / sqrt 2
//   flip_k  = (psi_i - psi_j) / (s_i - s_j)   on  U (e_i e_j^T + e_j e_i^T) V^T / sqrt 2.
#pragma once

#include "material/law.hpp"
#include "material/polar.hpp"

namespace brainshift {

struct IsotropicModes {
  Mat3 scaling;      // d2 psi / d s_i d s_j, kPa
  Vec3 twist, flip;  // kPa
};

// Removes the negative part of every mode from A: unchanged, bit for bit, where A has none.
void remove_negative_modes(const Polar& polar, const IsotropicModes& modes, Mat9& A);

}  // namespace brainshift
