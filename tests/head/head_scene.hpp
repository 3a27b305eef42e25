// The shipped head as tests see it; HEAD_FOLDER is set by CMake, coarse or medium.
#pragma once

#include <cstdio>

#include "procedure.hpp"

namespace dbs {

inline const Head& shipped_head() {
  static const Head head = read_head(HEAD_FOLDER);
  return head;
}

inline Options quiet_options() {
  Options o;
  o.head = HEAD_FOLDER;
  o.quiet = true;
  return o;
}

// A stepper on the head, and the ids of its contact groups.
struct HeadStepper {
  explicit HeadStepper(const Options& o)
      : stepper(make_scene(shipped_head(), o, ids)),
        full(full_level(shipped_head(), gravity_of(o.elevation))) {}
  SceneIds ids;
  Stepper stepper;
  double full;  // mm
  Index compartment(int side) const { return stepper.csf().find(name_of(side)); }
};

inline double largest_motion(const Points& u) { return u.rowwise().norm().maxCoeff(); }

}  // namespace dbs
