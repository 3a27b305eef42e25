// A device on its track: the beam, what holds it, the material points it is tied to.
#pragma once

#include <array>
#include <vector>

#include "beam/beam.hpp"
#include "beam/centreline.hpp"
#include "brainshift/insertion.hpp"
#include "coupling/track.hpp"

namespace brainshift {

// What of a device changes in a solve.
struct DeviceMotion {
  BeamState beam;
  // Per path point: forces (mN) of the device on the tissue along two fixed directions across and
  // one along the device, as multipliers of its rows.
  std::vector<Vec3> multipliers;
  // Of an anchor with slack, on the device: across (2), and of its stops against moving in and out.
  std::array<double, 4> anchor{};
  Points velocity;   // of the nodes, mm/s
};

struct InsertedDevice {
  DeviceId id = -1;
  Beam beam;
  Placement placement;
  Hold hold;
  TrackOptions options;
  std::vector<PathPoint> path;
  DeviceMotion motion;   // the last good one

  // Dofs (6 per node) that the hold takes away.
  std::vector<Index> held_dofs() const;
  // Its anchor lets the wire turn, save about its own tangent: nothing else keeps a round wire from
  // spinning about itself.
  bool is_hinged() const;
  Index anchor_node() const;   // nearest to the anchor; -1 without one
};

// Straight along the placement, unloaded.
InsertedDevice place_device(DeviceId id, const BeamDevice& device, const Placement& placement,
                            const Hold& hold, const TrackOptions& options,
                            std::vector<PathPoint> path);

// Largest friction (mN) on the part of the track that path point `p` stands for, when that point lies at
// an arc length of the device.
double friction_bound(const InsertedDevice& device, std::size_t p, double arc);

// Friction the device cannot bear falls to what it can.
void clamp_friction(InsertedDevice& device);

// Where the ties of a path point take hold, for displacements u.
Vec3 path_position(const Mesh& mesh, const Points& u, const PathPoint& point);

}  // namespace brainshift
