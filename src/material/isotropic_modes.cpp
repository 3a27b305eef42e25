#include "material/isotropic_modes.hpp"

#include "material/mat9.hpp"
#include "material/symmetric_eigen.hpp"

namespace brainshift {
namespace {

constexpr double sqrt_half = 0.70710678118654752440;

// A -= value q q^T with q = U m V^T, where value < 0; |m| = 1.
void remove(const Polar& polar, const Mat3& m, double value, Mat9& A) {
  const Mat3 mode = polar.U * m * polar.V.transpose();
  const Vec9 q = as_vector(mode);
  A.noalias() -= value * q * q.transpose();
}

}  // namespace

void remove_negative_modes(const Polar& polar, const IsotropicModes& modes, Mat9& A) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    Mat3 m = Mat3::Zero();
    if (modes.twist[k] < 0.0) {
      m(i, j) = sqrt_half;
      m(j, i) = -sqrt_half;
      remove(polar, m, modes.twist[k], A);
    }
    if (modes.flip[k] < 0.0) {
      m(i, j) = m(j, i) = sqrt_half;
      remove(polar, m, modes.flip[k], A);
    }
  }
  const SymmetricEigen eigen = symmetric_eigen(modes.scaling);
  for (int k = 0; k < 3; ++k) {
    if (eigen.values[k] < 0.0) {
      remove(polar, eigen.vectors.col(k).asDiagonal(), eigen.values[k], A);
    }
  }
}

}  // namespace brainshift
