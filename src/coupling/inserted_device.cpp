#include "coupling/inserted_device.hpp"

#include <algorithm>
#include <cmath>

#include "beam/rigid_device.hpp"

namespace brainshift {

std::vector<Index> InsertedDevice::held_dofs() const {
  std::vector<Index> dofs;
  const Eigen::VectorXd& arcs = beam.device().arcs();
  const double slack = 1e-9 * beam.device().length();
  const Index anchor = anchor_node();
  for (Index i = 0; i < beam.node_count(); ++i) {
    const bool rigid = arcs[i] >= hold.rigid_from - slack;
    const bool here = i == anchor;
    for (int k = 0; k < 6; ++k) {
      const bool shift = k < 3;
      // With slack, rows of the coupling hold its place.
      const bool held = shift ? hold.slack == 0.0 : hold.clamped;
      if (rigid || (here && held)) dofs.push_back(6 * i + k);
    }
  }
  return dofs;
}

bool InsertedDevice::is_hinged() const {
  const Index anchor = anchor_node();
  if (anchor < 0 || hold.clamped) return false;
  return beam.device().arcs()[anchor] < hold.rigid_from - 1e-9 * beam.device().length();
}

Index InsertedDevice::anchor_node() const {
  if (!std::isfinite(hold.anchor)) return -1;
  Eigen::Index node;
  (beam.device().arcs().array() - hold.anchor).abs().minCoeff(&node);
  return Index(node);
}

InsertedDevice place_device(DeviceId id, const BeamDevice& device, const Placement& placement,
                            const Hold& hold, const TrackOptions& options,
                            std::vector<PathPoint> path) {
  double radius = device.section(0).radius;
  const RigidDevice pose(placement.tip, placement.outward, device.length(), radius);
  InsertedDevice inserted{id, Beam(device, placement.tip, pose.frame()), placement, hold, options,
                          std::move(path), {}};
  inserted.motion.beam = inserted.beam.rest();
  inserted.motion.velocity.setZero(inserted.beam.node_count(), 3);
  inserted.motion.multipliers.assign(inserted.path.size(), Vec3::Zero());
  return inserted;
}

double friction_bound(const InsertedDevice& device, std::size_t p, double arc) {
  constexpr double pi = 3.14159265358979323846;
  const double surface = 2.0 * pi * device.beam.device().radius_at(arc) * device.path[p].length;
  return device.options.shear_bound * surface + (p == 0 ? device.options.tip_bound : 0.0);
}

void clamp_friction(InsertedDevice& device) {
  for (std::size_t p = 0; p < device.path.size(); ++p) {
    const double bound = friction_bound(device, p, device.path[p].arc);
    double& force = device.motion.multipliers[p][2];
    force = std::clamp(force, -bound, bound);
  }
}

Vec3 path_position(const Mesh& mesh, const Points& u, const PathPoint& point) {
  Vec3 mean = Vec3::Zero();
  for_each_tie_point(point, [&](Index tet, const Eigen::Vector4d& weights, double share) {
    const Interpolation at = mesh.interpolation(tet, weights);
    mean += share * (at.of(mesh.nodes()) + at.of(u));
  });
  return mean;
}

}  // namespace brainshift
