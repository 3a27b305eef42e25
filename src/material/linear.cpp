// Hooke's law of small strain: psi = mu |e|^2 + lambda/2 tr^2 e, e = sym G.
#include "material/laws.hpp"
#include "material/mat9.hpp"

namespace brainshift {
namespace {

double energy(const Lame& lame, const Mat3& G) {
  const double trace = G.trace();
  const Mat3 strain = 0.5 * (G + G.transpose());
  return lame.mu * strain.squaredNorm() + 0.5 * lame.lambda * trace * trace;
}

Mat3 stress(const Lame& lame, const Mat3& G) {
  Mat3 P = lame.mu * (G + G.transpose());
  P.diagonal().array() += lame.lambda * G.trace();
  return P;
}

// Positive semidefinite as it is: mu > 0 and K > 0.
void tangent(const Lame& lame, const Mat3& G, bool, Mat3& P, Mat9& A) {
  P = stress(lame, G);
  A.setZero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      A(3 * j + i, 3 * j + i) += lame.mu;
      A(3 * j + i, 3 * i + j) += lame.mu;
      A(4 * i, 4 * j) += lame.lambda;
    }
  }
}

VolumeMeasure volume(const Mat3& G) { return {G.trace(), Mat3::Identity(), Mat9::Zero()}; }

}  // namespace

const LawFunctions linear_law = {energy, stress, one_after_the_other<energy, stress>, tangent, nullptr, volume};

}  // namespace brainshift
