// A constitutive law as a set of functions of the displacement gradient G (F = I + G).
// A new law is one file with these functions and one line in registry.cpp.
#pragma once

#include <array>

#include "brainshift/types.hpp"

namespace brainshift {

using Mat9 = Eigen::Matrix<double, 9, 9>;

struct Lame {
  double mu, lambda;  // kPa
};

struct VolumeMeasure {
  double value;
  Mat3 gradient;
  Mat9 hessian;
};

// dP/dF = diagonal I + sum_k weight_k vec(mode_k) vec(mode_k)^T
struct ModalTangent {
  double diagonal;
  std::array<double, 4> weight;
  std::array<Mat3, 4> mode;
};

struct LawFunctions {
  double (*energy)(const Lame&, const Mat3& G);
  Mat3 (*stress)(const Lame&, const Mat3& G);  // first Piola-Kirchhoff
  // Both, where they share work; P: the stress.
  double (*energy_and_stress)(const Lame&, const Mat3& G, Mat3& P);
  // stress and tangent dP/dF together (both are needed in an assembly); column-major 9-vectors
  void (*tangent)(const Lame&, const Mat3& G, bool definite, Mat3& P, Mat9& A);
  // The same tangent, of a law where it has so few modes: null for others.
  void (*modal_tangent)(const Lame&, const Mat3& G, bool definite, ModalTangent& A);
  // The measure theta of the change of volume whose square lambda multiplies, psi = psi(mu, 0) +
  // lambda/2 theta^2, and its derivatives by F. An element that averages theta takes it apart so.
  VolumeMeasure (*volume)(const Mat3& G);
};

// For a law whose energy and stress share none.
template <double (*energy)(const Lame&, const Mat3&), Mat3 (*stress)(const Lame&, const Mat3&)>
double one_after_the_other(const Lame& lame, const Mat3& G, Mat3& P) {
  P = stress(lame, G);
  return energy(lame, G);
}

}  // namespace brainshift
