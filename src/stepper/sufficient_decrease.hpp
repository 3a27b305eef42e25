// Armijo's rule with an allowance for rounding.
#pragma once

#include <cmath>

namespace brainshift {

// Whether a merit that has changed by `change` has fallen by enough of `predicted`, what it should
// fall by to first order. Infinite or undefined changes never have: where an energy is infinite the
// allowance, which is relative to the energies, would be infinite with it and let anything pass.
inline bool sufficient_decrease(double change, double predicted, double rounding) {
  constexpr double enough = 1e-4;  // Nocedal & Wright, Numerical Optimization, section 3.1
  return std::isfinite(change) && change <= -enough * predicted + rounding;
}

}  // namespace brainshift
