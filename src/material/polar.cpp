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

}  // namespace

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
