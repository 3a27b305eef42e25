// The straight line an electrode is planned on, in the frame of the skull.
#pragma once

#include "head.hpp"
#include "options.hpp"

namespace dbs {

struct Trajectory {
  Vec3 target, outward;   // unit, from the target to the burr hole
  Vec3 inner_table;       // where the line meets the inside of the skull: the wire is fixed here
  double length;          // mm, target to inner table
};

// Unit vector from a target outwards: `sagittal` degrees above the horizontal in the sagittal plane,
// leaning `lateral` degrees to the side (RAS).
Vec3 outward_of(int side, double sagittal, double lateral);

// The line from `target` along `outward`, cut by the skull. Throws brainshift::Error naming the side
// when the target is not in tissue of that side or the line crosses the midline.
Trajectory make_trajectory(const Head& head, int side, const Vec3& target, const Vec3& outward);

// What the options ask for; where they say nothing, the plan that comes with the head.
Trajectory plan_trajectory(const Head& head, const Options& options, int side);

}  // namespace dbs
