// --plan: what it finds is what the procedure gives, and no target is missed that aiming can meet.
#include <gtest/gtest.h>

#include "alternatives.hpp"
#include "head_scene.hpp"

namespace dbs {
namespace {

Options asked() {
  Options o = quiet_options();
  o.sides = "right";
  o.tether = 0.0;   // the lead then keeps part of the shift
  o.right = o.left = "10mL";
  return o;
}

// The last stage of a procedure of its own, from the start.
StageResult procedure_of(const Options& o) {
  Procedure procedure(shipped_head(), o);
  StageResult last{};
  for (const Stage& stage : procedure.plan()) last = procedure.run(stage);
  return last;
}

TEST(Alternatives, AreWhatTheProcedureGivesAndTheBestMeetsTheTargets) {
  int told = 0;
  const auto found =
      search_alternatives(shipped_head(), asked(), [&told](const Alternative&) { ++told; });
  EXPECT_EQ(told, int(found.size()));
  EXPECT_TRUE(found.front().words.empty());
  for (const Alternative& a : found) {
    std::printf("%s: %.3f mm off (%s) %s\n", a.name.c_str(), a.mean(), a.words.c_str(),
                a.message.c_str());
  }
  const Alternative& best = best_of(found);
  EXPECT_GT(found.front().mean(), 0.3);
  EXPECT_LT(best.mean(), 0.05);
  EXPECT_FALSE(best.options.offset_right.empty());
  const StageResult last = procedure_of(best.options);   // no branch
  ASSERT_TRUE(last.lead[right]);
  EXPECT_LT((last.lead[right]->off_target - best.miss.at(right).off).norm(), 1e-6);
}

TEST(Alternatives, RefuseWhatHasNothingToPlan) {
  Options o = asked();
  o.devices = false;
  EXPECT_THROW(search_alternatives(shipped_head(), o, {}), Error);
}

TEST(Alternatives, ReplanningThatCannotBeChangesNothing) {
  Procedure procedure(shipped_head(), asked());
  procedure.run(procedure.plan()[0]);
  Options o = asked();
  o.first = "left";
  o.offset_right = {200.0, 0.0, 0.0};   // outside the head
  EXPECT_THROW(procedure.replan(o), Error);
  ASSERT_EQ(procedure.plan()[1].side, right);
  EXPECT_TRUE(procedure.run(procedure.plan()[1]).report.converged());
}

// A contact planned at the target lies there, and the tip deeper.
TEST(Alternatives, AContactCanBeWhatIsAimedWith) {
  Options o = asked();
  o.contact = 2;
  Procedure procedure(shipped_head(), o);
  StageResult last{};
  for (const Stage& stage : procedure.plan()) {
    last = procedure.run(stage);
    if (stage.label == "3") break;
  }
  ASSERT_TRUE(last.lead[right]);
  const DeviceState& lead = last.lead[right]->state;
  const Vec3 goal = plan_goal(shipped_head(), o, right).point;
  EXPECT_LT((lead.contact_centres.row(1).transpose() - goal).norm(), 1e-9);
  EXPECT_NEAR((lead.nodes.row(0).transpose() - goal).norm(), 1.5 + 1.5 + 0.5 + 0.75, 1e-9);
  o.contact = 5;
  EXPECT_THROW(Procedure(shipped_head(), o), Error);
}

}  // namespace
}  // namespace dbs
