// Polar and singular value decomposition of a deformation gradient, reflections excluded.
#pragma once

#include "brainshift/types.hpp"

namespace brainshift {

// F = I + G = U diag(s) V^T = R S, R = U V^T.
// det R = +1 always: for an inverted F the singular value of smallest magnitude is negative
// (Irving, Teran, Fedkiw 2004). Hence s_i + s_j >= 0 for every pair.
struct Polar {
  Mat3 R, U, V;
  Vec3 strain;  // s_i - 1, formed without cancellation
};

Polar polar_decomposition(const Mat3& G);

// The same without axes, several times faster: F = R (I + D).
struct Stretch {
  Mat3 R, D;   // D = S - I, formed without cancellation
};

Stretch stretch(const Mat3& G);

}  // namespace brainshift
