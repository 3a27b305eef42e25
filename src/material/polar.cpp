#include "material/polar.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "material/mat9.hpp"
#include "material/symmetric_eigen.hpp"

namespace brainshift {
namespace {

// Slow and sure: flat, inverted, nearly singular, all zero.
Polar polar_by_svd(const Mat3& F) {
  Polar polar;
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.info() != Eigen::Success) {  // F is not finite; svd holds what was in memory
    const double nan = std::numeric_limits<double>::quiet_NaN();
    polar.R.setConstant(nan);
    polar.U = polar.V = polar.R;
    polar.strain.setConstant(nan);
    return polar;
  }
  Vec3 s = svd.singularValues();  // descending
  polar.U = svd.matrixU();
  polar.V = svd.matrixV();
  if (polar.U.determinant() * polar.V.determinant() < 0.0) {
    polar.U.col(2) *= -1.0;
    s[2] = -s[2];
  }
  polar.R = polar.U * polar.V.transpose();
  polar.strain = s.array() - 1.0;
  return polar;
}

// Newton's iteration for the rotation nearest to F (Higham 1986, unscaled), which converges quadratically
// from any F with det F > 0; false where it does not in a few steps, far from a rotation.
bool nearest_rotation(const Mat3& F, Mat3& R) {
  constexpr int most = 9;
  constexpr double enough = 1e-8;   // the next step squares it
  R = F;
  for (int i = 0; i < most; ++i) {
    const Mat3 C = cofactor(R);
    const double det = R.col(0).dot(C.col(0));
    if (!(det > 1e-6)) return false;   // of a flat tet, and of no number
    const Mat3 next = 0.5 * (R + C / det);
    const double change = (next - R).cwiseAbs().maxCoeff();
    R = next;
    if (change <= enough) return true;
  }
  return false;
}

}  // namespace

// D (2 I + D) = 2 E: one step of D = 2 E (2 I + D)^-1 gives the digits that R^T F - I has lost.
Stretch stretch(const Mat3& G) {
  const Mat3 F = Mat3::Identity() + G;
  Stretch result;
  if (!nearest_rotation(F, result.R)) {
    const Polar polar = polar_decomposition(G);
    const Mat3 D = polar.V * polar.strain.asDiagonal() * polar.V.transpose();
    return {polar.R, 0.5 * (D + D.transpose())};
  }
  Mat3 M = result.R.transpose() * F;   // S
  M.diagonal().array() += 1.0;
  const Mat3 C = cofactor(M);          // M is symmetric but for rounding
  const Mat3 D = (2.0 / M.col(0).dot(C.col(0))) * green_strain(G) * C.transpose();
  result.D = 0.5 * (D + D.transpose());
  return result;
}

Polar polar_decomposition(const Mat3& G) {
  const Mat3 F = Mat3::Identity() + G;
  const SymmetricEigen eigen = symmetric_eigen(green_strain(G));
  const Vec3 squared = 1.0 + 2.0 * eigen.values.array();
  // s^2 carries an absolute error of eps * max(s^2): below this ratio R would lose digits.
  constexpr double smallest_ratio = 1e-3;
  const bool regular = squared.minCoeff() > smallest_ratio * squared.maxCoeff();
  if (!regular || !(F.determinant() > 0.0)) return polar_by_svd(F);  // NaN goes there, too

  const Vec3 s = squared.cwiseSqrt();
  Polar polar;
  polar.V = eigen.vectors;
  polar.strain = 2.0 * eigen.values.array() / (1.0 + s.array());
  polar.U = F * polar.V * s.cwiseInverse().asDiagonal();
  polar.R = polar.U * polar.V.transpose();
  return polar;
}

}  // namespace brainshift
