#include "material/symmetric_eigen.hpp"

#include <cmath>

namespace brainshift {
namespace {

// One rotation in the plane (p, q) that annihilates a(p, q); r is the third index.
// Golub & Van Loan, Matrix Computations, section 8.5.
inline void rotate(Mat3& a, Mat3& v, int p, int q, int r) {
  const double off = a(p, q);
  if (off == 0.0) return;
  const double theta = 0.5 * (a(q, q) - a(p, p)) / off;
  // |theta| may overflow to infinity for tiny `off`: t = 0 then, as it should be
  const double t = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
  a(p, p) -= t * off;
  a(q, q) += t * off;
  a(p, q) = a(q, p) = 0.0;
  const double rp = a(r, p), rq = a(r, q);
  a(r, p) = a(p, r) = c * rp - s * rq;
  a(r, q) = a(q, r) = s * rp + c * rq;
  const Vec3 vp = v.col(p), vq = v.col(q);
  v.col(p) = c * vp - s * vq;
  v.col(q) = s * vp + c * vq;
}

}  // namespace

SymmetricEigen symmetric_eigen(const Mat3& m) {
  constexpr int max_sweeps = 12;
  constexpr double negligible = 1e-17;  // of the largest diagonal entry
  Mat3 a = m;
  SymmetricEigen result;
  result.vectors.setIdentity();
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    const double off = std::abs(a(0, 1)) + std::abs(a(0, 2)) + std::abs(a(1, 2));
    if (off <= negligible * a.diagonal().cwiseAbs().maxCoeff()) break;
    rotate(a, result.vectors, 0, 1, 2);
    rotate(a, result.vectors, 0, 2, 1);
    rotate(a, result.vectors, 1, 2, 0);
  }
  result.values = a.diagonal();
  return result;
}

}  // namespace brainshift
