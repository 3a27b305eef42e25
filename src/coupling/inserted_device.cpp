#include "coupling/inserted_device.hpp"

#include <cmath>

#include "beam/rigid_device.hpp"

namespace brainshift {

std::vector<Index> InsertedDevice::held_dofs() const {
  std::vector<Index> dofs;
  const Eigen::VectorXd& arcs = beam.device().arcs();
  const double slack = 1e-9 * beam.device().length();
  // The node nearest to the anchor holds the wire.
  Eigen::Index anchor = -1;
  if (std::isfinite(hold.anchor)) (arcs.array() - hold.anchor).abs().minCoeff(&anchor);
  for (Index i = 0; i < beam.node_count(); ++i) {
    const bool rigid = arcs[i] >= hold.rigid_from - slack;
    const bool here = i == Index(anchor);
    const int count = rigid || (here && hold.clamped) ? 6 : here ? 3 : 0;
    for (int k = 0; k < count; ++k) dofs.push_back(6 * i + k);
    // Nothing but its anchor keeps a round wire from spinning about itself.
    if (here && count == 3) dofs.push_back(6 * i + 3);
  }
  return dofs;
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

Vec3 path_position(const Mesh& mesh, const Points& u, const PathPoint& point) {
  Vec3 x = Vec3::Zero();
  for (int a = 0; a < 4; ++a) {
    const Index node = mesh.tets()(point.tet, a);
    x += point.weights[a] * (mesh.nodes().row(node) + u.row(node)).transpose();
  }
  return x;
}

}  // namespace brainshift
