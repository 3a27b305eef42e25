// A device in tissue: where it was put, what holds it, and what a solve found.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "brainshift/beam_device.hpp"
#include "brainshift/types.hpp"

namespace brainshift {

using DeviceId = std::int32_t;

// A straight device lies from `tip` along `outward` (unit, from the tip to the wire end), in the
// frame of the skull, in the brain as it is now.
struct Placement {
  Vec3 tip;
  Vec3 outward;
};

// What holds a device, as arc lengths from its tip (mm).
struct Hold {
  // From here to the wire end the device stays where it was put: inside a cannula clamped by the
  // stereotactic frame, or (0) all of it.
  double rigid_from = std::numeric_limits<double>::infinity();
  // Here the wire is fixed to the skull, free to turn unless `clamped`.
  double anchor = std::numeric_limits<double>::infinity();
  bool clamped = false;
  // The wire may slide this far (mm) along its placement, either way, before the skull holds it.
  double slack = 0.0;
};

struct TrackOptions {
  double shear_bound = 0.0;    // kPa; friction along the device: bound * 2 pi r per length
  double tip_bound = 0.0;      // mN; friction besides, at the deepest point of the track: tissue that
                               // has grown onto the tip
  double least_spacing = 1.0;  // mm; path points closer than this are one
  // Elements wider than the device feel it as a rod of their own width: tissue seems too stiff across it,
  // twofold and more at elements of 5 mm. true: each tie acts over a ring as wide as they are and gives way
  // by what is missing, docs/theory.md (25). The tissue beside the device then lies off it by that much.
  bool local_give = false;
};

// State of an inserted device. Forces act on the tissue (mN).
struct DeviceState {
  std::string name;
  Points nodes;                  // N x 3, mm; node 0 is the tip
  std::vector<Mat3> frames;      // N; columns d1 (along the device), d2, d3
  Points contact_centres;        // stimulating contacts, from the tip
  Points path;                   // P x 3: where the material points of the track are now
  Eigen::VectorXd path_arcs;     // P; arc length on the device; NaN where the tip is above the point
  Points path_forces;            // P x 3
  // mN, of what holds the device (skull, frame) on it: what tissue does not; in step(), without the
  // device's own inertia.
  Vec3 anchor_force;
  double slide = 0.0;            // mm; how far slack has let the anchored section out (+) or in (-)
  double bow = 0.0;              // mm; largest distance from the chord tip - anchored section
  double bow_arc = 0.0;          // mm from the tip
  Vec3 bow_direction;            // unit; zero without bow
  double largest_tie_gap = 0.0;  // mm; what the transverse ties leave open
};

}  // namespace brainshift
