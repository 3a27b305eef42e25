// Groups, their ids, and what is refused.
#include "brainshift/constraint_set.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "brainshift/error.hpp"
#include "support/shapes.hpp"

namespace brainshift {
namespace {

Surface plane() {
  const auto sheet = test::make_sheet(20, 20, 4, 4);
  return Surface::sheet(sheet.points, sheet.triangles);
}

template <class Call>
void expect_error(ErrorCode code, Call&& call) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& e) {
    EXPECT_EQ(to_string(e.code()), std::string(to_string(code))) << e.what();
    EXPECT_NE(std::string(e.what()).find("culprit"), std::string::npos) << e.what();
  }
}

TEST(ConstraintSet, IdsStayValidWhileOthersComeAndGo) {
  ConstraintSet set;
  const ConstraintId a = set.fix("a", {0}), b = set.tie("b", {1}, {2});
  set.remove(a);
  const ConstraintId c = set.support("c", {3}, Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_NE(c, a);
  EXPECT_NE(c, b);
  EXPECT_EQ(set.group(b).name, "b");
  EXPECT_EQ(set.group(c).kind, ConstraintKind::support);
  EXPECT_EQ(set.groups().size(), 2u);
  EXPECT_THROW(set.group(a), Error);
}

TEST(ConstraintSet, GroupsAreEnabledAndDisabled) {
  ConstraintSet set;
  const ConstraintId a = set.fix("a", {0});
  EXPECT_TRUE(set.group(a).enabled);
  set.disable(a);
  EXPECT_FALSE(set.group(a).enabled);
  set.enable(a);
  EXPECT_TRUE(set.group(a).enabled);
  EXPECT_THROW(set.enable(99), Error);
  EXPECT_THROW(set.disable(-1), Error);
  EXPECT_THROW(set.remove(99), Error);
}

TEST(ConstraintSet, OneStiffnessServesAllNodes) {
  ConstraintSet set;
  const ConstraintId a = set.support("a", {0, 5, 7}, Eigen::VectorXd::Constant(1, 2.0));
  ASSERT_EQ(set.group(a).stiffness.size(), 3);
  EXPECT_EQ(set.group(a).stiffness[2], 2.0);
}

TEST(ConstraintSet, RefusesWhatCannotBeAndNamesTheGroup) {
  ConstraintSet set;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Points up(1, 3), longer(1, 3);
  up << 0, 0, 1;
  longer << 0, 0, 2;
  expect_error(ErrorCode::empty, [&] { set.fix("culprit", {}); });
  expect_error(ErrorCode::invalid_argument, [&] {
    set.fix("culprit", {0}, {false, false, false});
  });
  expect_error(ErrorCode::size_mismatch, [&] { set.tie("culprit", {0, 1}, {2}); });
  expect_error(ErrorCode::size_mismatch, [&] {
    set.support("culprit", {0, 1, 2}, Eigen::Vector2d(1, 1));
  });
  expect_error(ErrorCode::invalid_argument,
               [&] { set.support("culprit", {0}, Eigen::VectorXd::Constant(1, -1.0)); });
  expect_error(ErrorCode::not_finite,
               [&] { set.support("culprit", {0}, Eigen::VectorXd::Constant(1, nan)); });
  expect_error(ErrorCode::invalid_argument, [&] { set.obstacle("culprit", {0}, plane(), 0.5); });
  expect_error(ErrorCode::not_finite, [&] {
    set.obstacle("culprit", {0}, plane(), 1.0, Eigen::VectorXd::Constant(1, nan));
  });
  expect_error(ErrorCode::size_mismatch,
               [&] { set.obstacle("culprit", {0}, plane(), 1.0, Eigen::Vector2d(1, 1)); });
  expect_error(ErrorCode::size_mismatch, [&] { set.opposing("culprit", {0}, {1, 2}, up); });
  expect_error(ErrorCode::size_mismatch, [&] { set.opposing("culprit", {0, 1}, {2, 3}, up); });
  expect_error(ErrorCode::invalid_argument, [&] { set.opposing("culprit", {0}, {1}, longer); });
  EXPECT_TRUE(set.groups().empty());
}

}  // namespace
}  // namespace brainshift
