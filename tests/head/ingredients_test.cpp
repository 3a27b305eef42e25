// What each ingredient of the model does on the head: printed without threshold (the signs are
// asserted on small built scenes in tests/stepper); only the balance of each solve is asserted.
#include <gtest/gtest.h>

#include "head_scene.hpp"

namespace dbs {
namespace {

void show(const char* what, const Options& o) {
  Procedure procedure(shipped_head(), o);
  for (const Stage& stage : procedure.plan()) {
    if (stage.action == Action::restore) break;
    const StageResult s = procedure.run(stage);
    ASSERT_TRUE(s.report.converged()) << what << ": " << s.report.message;
    if (stage.action == Action::none) continue;
    const Vec3 l = s.shifts.at("STN_left"), r = s.shifts.at("STN_right");
    std::printf(
        "%-34s surface left %5.2f right %5.2f, midline %6.3f mm, "
        "STN left (%5.2f %5.2f %5.2f) right (%5.2f %5.2f %5.2f), air %.1f mL\n",
        what, s.surface_motion[left], s.surface_motion[right], s.midline_shift, l.x(), l.y(), l.z(),
        r.x(), r.y(), r.z(), (s.fluid[left].air_volume + s.fluid[right].air_volume) / mm3_per_ml);
  }
}

TEST(Ingredients, OnAndOff) {
  Options base = quiet_options();
  base.right = "20mL";
  base.sides = "right";
  base.devices = false;
  base.late = 0.0;
  std::printf("20 mL of fluid lost on the right\n");
  for (const char* fluid : {"communicating", "separate"}) {
    for (bool falx : {true, false}) {
      Options o = base;
      o.fluid = fluid;
      o.falx = falx;
      show((std::string(fluid) + (falx ? ", falx" : ", no falx")).c_str(), o);
    }
    Options o = base;
    o.fluid = fluid;
    o.skull = false;
    show((std::string(fluid) + ", falx, no skull").c_str(), o);
  }
}

}  // namespace
}  // namespace dbs
