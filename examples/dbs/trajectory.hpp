// The straight line an electrode is planned on, in the frame of the skull.
#pragma once

#include "head.hpp"
#include "options.hpp"

namespace dbs {

struct Trajectory {
  Vec3 target;            // of the tip
  Vec3 outward;           // unit, from the target to the burr hole
  Vec3 inner_table;       // where the line meets the inside of the skull: the wire is fixed here
  double length;          // mm, target to inner table
};

// What is to be stimulated, and the direction it is reached from.
struct Goal {
  Vec3 point, outward;
};

// Unit vector from a target outwards: `sagittal` degrees above the horizontal in the sagittal plane,
// leaning `lateral` degrees to the side (RAS).
Vec3 outward_of(int side, double sagittal, double lateral);

// The line from `target` along `outward`, cut by the skull. Throws brainshift::Error naming the side
// when the target is not in tissue of that side or the line crosses the midline.
Trajectory make_trajectory(const Head& head, int side, const Vec3& target, const Vec3& outward);

// From the tip to the middle of the contact that is to lie at the target (mm).
double contact_arc(const Options& options);

// What the options ask for; where they say nothing, the plan that comes with the head.
Goal plan_goal(const Head& head, const Options& options, int side);
// The line on which the planned contact comes to lie at `point`, plus what the options aim beside it.
Trajectory aim_at(const Head& head, const Options& options, int side, const Vec3& point,
                  const Vec3& outward);

}  // namespace dbs
