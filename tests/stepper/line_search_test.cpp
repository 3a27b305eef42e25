// Which changes of the merit a line search accepts.
#include "stepper/sufficient_decrease.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace brainshift {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(SufficientDecrease, AsksForAPartOfThePredictedFall) {
  EXPECT_TRUE(sufficient_decrease(-0.5, 1.0, 0.0));
  EXPECT_FALSE(sufficient_decrease(-1e-5, 1.0, 0.0));
  EXPECT_FALSE(sufficient_decrease(1e-3, 1.0, 0.0));
}

TEST(SufficientDecrease, AllowsForRounding) {
  EXPECT_TRUE(sufficient_decrease(1e-15, 1e-20, 1e-12));
  EXPECT_FALSE(sufficient_decrease(1e-11, 1e-20, 1e-12));
}

// The rounding of an infinite energy is infinite, of one that is not a number not a number.
TEST(SufficientDecrease, NeverAcceptsWhatIsNotFinite) {
  for (const double change : {inf, -inf, nan}) {
    for (const double rounding : {0.0, 1.0, inf, nan}) {
      EXPECT_FALSE(sufficient_decrease(change, 1.0, rounding)) << change << " " << rounding;
    }
  }
  EXPECT_FALSE(sufficient_decrease(-1.0, nan, 0.0));
}

}  // namespace
}  // namespace brainshift
