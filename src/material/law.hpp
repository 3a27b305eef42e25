// A constitutive law as a set of functions of the displacement gradient G (F = I + G).
// A new law is one file with these functions and one line in registry.cpp.
#pragma once

#include "brainshift/types.hpp"

namespace brainshift {

using Mat9 = Eigen::Matrix<double, 9, 9>;

struct Lame {
  double mu, lambda;  // kPa
};

struct LawFunctions {
  double (*energy)(const Lame&, const Mat3& G);
  Mat3 (*stress)(const Lame&, const Mat3& G);  // first Piola-Kirchhoff
  // stress and tangent dP/dF together (both are needed in an assembly); column-major 9-vectors
  void (*tangent)(const Lame&, const Mat3& G, bool definite, Mat3& P, Mat9& A);
};

}  // namespace brainshift
