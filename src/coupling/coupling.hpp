// Rows that couple tissue and devices at one state, and what they do to both.
//
// Each path point whose foot lies on the device has two rows across it,
//   n_k . (x_point - c) = 0,   k = 1, 2,   c the closest point of the centreline,
// and one along it with a bounded multiplier where there is friction:
//   0 = slip since the last solve,  |multiplier| <= shear bound * 2 pi r * length.
// To first order at a closed tie the foot does not move along (t . (x - c) = 0), so the gradient is
// n_k on the tissue point and -n_k dc/dq on the device.
//
// A wire anchored with slack s at the point a of the skull has rows of its own, c now its anchored
// section and t the direction of its placement: two across, n_k . (a - c) = 0, and two one-sided ones,
//   s + t . (a - c) >= 0,   s - t . (a - c) >= 0.
#pragma once

#include <vector>

#include "contact/blocks.hpp"
#include "coupling/inserted_device.hpp"

namespace brainshift {

enum class RowKind { across, along, anchor_across, anchor_stop };

struct CouplingRow {
  std::size_t device, point;   // of the path; of an anchor: unused
  int axis;              // 0, 1: across; 2: along; of an anchor: 0 to 3
  RowKind kind;
  Vec3 direction;
  BeamPoint place;
  double gap;            // mm; across: distance still open; along: slip since the last solve
  double lower, upper;   // mN, bounds of the multiplier
  double give = 0.0;     // mm/mN; the gap counts give * multiplier in, what tissue at the device gives way

  bool one_sided() const { return kind == RowKind::anchor_stop; }
  bool bilateral() const { return kind == RowKind::across || kind == RowKind::anchor_across; }
};

double& multiplier_of(DeviceMotion& motion, const CouplingRow& row);
double multiplier_of(const DeviceMotion& motion, const CouplingRow& row);

using DeviceVectors = std::vector<Eigen::VectorXd>;   // 6N per device

// How the force of the ties at a path point turns: with f that force on the tissue, a = f . dt the turn of
// the tangent towards it and b the slip of the point along the device, the energy's second derivative
// has 2 a b + (f . curvature) b^2 besides the device's own part.
struct TieTurn {
  CouplingRow slip;      // its direction is the tangent: the gradients of b
  Eigen::VectorXd turn;  // gradient of a on the dofs of the device
  double curvature;      // mN/mm
};

class Coupling {
 public:
  Coupling(const Mesh& mesh, const std::vector<InsertedDevice>& devices, const Points& start);

  bool empty() const { return m_devices.empty(); }
  const std::vector<InsertedDevice>& devices() const { return m_devices; }
  std::vector<DeviceMotion> motions() const;

  // Rows at a state.
  std::vector<CouplingRow> rows(const Points& u, const std::vector<DeviceMotion>& motions) const;
  // Forces of the rows with the multipliers in `motions`: on mesh nodes (N x 3, added), and on the
  // dofs of each device (added).
  void add_forces(const std::vector<CouplingRow>& rows, const std::vector<DeviceMotion>& motions,
                  Points& nodal, DeviceVectors& on_devices) const;

  // Motion of every path point along x, y, z: three columns each on blocks, in the order of devices and
  // their paths. A row on tissue is its direction in the three columns of its point, path_column().
  SparseColumns path_columns(const Blocks& blocks) const;
  bool is_on_tissue(const CouplingRow& row) const {
    return row.kind == RowKind::across || row.kind == RowKind::along;
  }
  Eigen::Index path_column(const CouplingRow& row) const;

  // Gradient of a row on the dofs of its device.
  Eigen::VectorXd device_gradient(const CouplingRow& row,
                                  const std::vector<DeviceMotion>& motions) const;

  // Second derivatives of the rows with the multipliers of `motions`: those that couple tissue and
  // device, and those on a device alone (added to K).
  std::vector<TieTurn> turns(const std::vector<CouplingRow>& rows,
                             const std::vector<DeviceMotion>& motions) const;
  void add_tangent(const std::vector<CouplingRow>& rows, const std::vector<DeviceMotion>& motions,
                   std::size_t d, BlockTridiagonal& K) const;

  // Takes what is held of device d out of a vector, or a matrix, on its dofs.
  void hold(std::size_t d, const BeamState& state, Eigen::VectorXd& v) const;
  void hold(std::size_t d, const BeamState& state, BlockTridiagonal& K) const;

 private:
  void add_anchor_rows(std::size_t d, const BeamState& state, std::vector<CouplingRow>& rows) const;

  const Mesh& m_mesh;
  const std::vector<InsertedDevice>& m_devices;
  std::vector<std::vector<Index>> m_held;
  std::vector<Eigen::Index> m_first_column;   // per device, of its path
  // Where each path point stood along its device when the solve began, for slip.
  std::vector<std::vector<double>> m_start_arcs;
};

}  // namespace brainshift
