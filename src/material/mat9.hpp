// 3 x 3 matrices as column-major 9-vectors, and the cofactor map with its derivative.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "material/law.hpp"

namespace brainshift {

using Vec9 = Eigen::Matrix<double, 9, 1>;

// The 9-vector (m00, m10, m20, m01, ...) of a matrix, without a copy.
inline Eigen::Map<const Vec9> as_vector(const Mat3& m) { return Eigen::Map<const Vec9>(m.data()); }

// skew(v) x = v cross x
inline Mat3 skew(const Vec3& v) {
  Mat3 s;
  s << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return s;
}

// cof(m) = det(m) m^-T, defined for every m; the gradient of det.
inline Mat3 cofactor(const Mat3& m) {
  Mat3 c;
  c.col(0) = m.col(1).cross(m.col(2));
  c.col(1) = m.col(2).cross(m.col(0));
  c.col(2) = m.col(0).cross(m.col(1));
  return c;
}

// A += factor * d cof(m) / d m, the Hessian of det (symmetric, indefinite).
inline void add_cofactor_derivative(const Mat3& m, double factor, Mat9& A) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;  // column i of cof is m_j x m_k
    const Mat3 s = factor * skew(m.col(k));
    A.block<3, 3>(3 * i, 3 * j) -= s;
    A.block<3, 3>(3 * j, 3 * i) += s;
  }
}

// The second invariant of a matrix, (tr^2 - tr(m m)) / 2.
inline double second_invariant(const Mat3& m) {
  const double trace = m.trace();
  return 0.5 * (trace * trace - m.cwiseProduct(m.transpose()).sum());
}

// det(I + G) - 1 without the cancellation of det(F) - 1.
inline double volume_change(const Mat3& G) {
  return G.trace() + second_invariant(G) + G.determinant();
}

// cof(I + G) - I = tr(G) I - G^T + cof G, without the cancellation of cof(F) - I.
inline Mat3 cofactor_change(const Mat3& G) {
  Mat3 c = cofactor(G) - G.transpose();
  c.diagonal().array() += G.trace();
  return c;
}

// Green's strain E = (F^T F - I) / 2, formed from G so that tiny strains keep their digits.
inline Mat3 green_strain(const Mat3& G) { return 0.5 * (G + G.transpose() + G.transpose() * G); }

}  // namespace brainshift
