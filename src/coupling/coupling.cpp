#include "coupling/coupling.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace brainshift {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// A direction across the tangent that varies smoothly: the section's own, made orthogonal to it.
Vec3 across(const Vec3& tangent, const Mat3& frame) {
  return (frame.col(1) - tangent.dot(frame.col(1)) * tangent).normalized();
}

}  // namespace

double& multiplier_of(DeviceMotion& motion, const CouplingRow& row) {
  const bool anchor = row.kind == RowKind::anchor_across || row.one_sided();
  return anchor ? motion.anchor[std::size_t(row.axis)] : motion.multipliers[row.point][row.axis];
}

double multiplier_of(const DeviceMotion& motion, const CouplingRow& row) {
  return multiplier_of(const_cast<DeviceMotion&>(motion), row);
}

Coupling::Coupling(const Mesh& mesh, const std::vector<InsertedDevice>& devices,
                   const Points& start)
    : m_mesh(mesh), m_devices(devices) {
  Eigen::Index columns = 0;
  for (const InsertedDevice& d : devices) {
    m_first_column.push_back(columns);
    columns += 3 * Eigen::Index(d.path.size());
    m_held.push_back(d.held_dofs());
    std::vector<double> arcs;
    for (const PathPoint& p : d.path) {
      const ClosestBeamPoint foot =
          closest_point(d.beam, d.motion.beam, path_position(mesh, start, p));
      arcs.push_back(foot.beyond == CurveEnd::none
                         ? arc_of(d.beam, foot.place)
                         : std::numeric_limits<double>::quiet_NaN());
    }
    m_start_arcs.push_back(std::move(arcs));
  }
}

std::vector<DeviceMotion> Coupling::motions() const {
  std::vector<DeviceMotion> all;
  for (const InsertedDevice& d : m_devices) all.push_back(d.motion);
  return all;
}

std::vector<CouplingRow> Coupling::rows(const Points& u,
                                        const std::vector<DeviceMotion>& motions) const {
  std::vector<CouplingRow> rows;
  for (std::size_t d = 0; d < m_devices.size(); ++d) {
    const InsertedDevice& device = m_devices[d];
    const BeamState& state = motions[d].beam;
    for (std::size_t p = 0; p < device.path.size(); ++p) {
      const Vec3 x = path_position(m_mesh, u, device.path[p]);
      const ClosestBeamPoint foot = closest_point(device.beam, state, x);
      if (foot.beyond != CurveEnd::none) continue;   // free track below the tip
      const Vec3 tangent = unit_tangent(device.beam, state, foot.place);
      const Vec3 first = across(tangent, state.R[std::size_t(foot.place.element)]);
      const Vec3 second = tangent.cross(first);
      const Vec3 off = x - foot.position;
      const double give = device.path[p].give;
      const Vec3 given = give * motions[d].multipliers[p];
      rows.push_back({d, p, 0, RowKind::across, first, foot.place, first.dot(off) + given[0],
                      -unbounded, unbounded, give});
      rows.push_back({d, p, 1, RowKind::across, second, foot.place, second.dot(off) + given[1],
                      -unbounded, unbounded, give});
      const double arc = arc_of(device.beam, foot.place), from = m_start_arcs[d][p];
      const double bound = friction_bound(device, p, arc);
      if (bound > 0.0) {
        const double slip = std::isnan(from) ? 0.0 : arc - from;
        rows.push_back({d, p, 2, RowKind::along, tangent, foot.place, slip, -bound, bound});
      }
    }
    add_anchor_rows(d, state, rows);
  }
  return rows;
}

void Coupling::add_anchor_rows(std::size_t d, const BeamState& state,
                               std::vector<CouplingRow>& rows) const {
  const InsertedDevice& device = m_devices[d];
  const Index node = device.anchor_node();
  if (node < 0 || device.hold.slack == 0.0) return;
  const double arc = device.beam.device().arcs()[node];
  const BeamPoint place = place_at(device.beam, arc);
  const Placement& at = device.placement;
  const Vec3 off = at.tip + arc * at.outward - position(device.beam, state, place);
  const Vec3 first = at.outward.unitOrthogonal(), second = at.outward.cross(first);
  const double slack = device.hold.slack, along = at.outward.dot(off);
  rows.push_back({d, 0, 0, RowKind::anchor_across, first, place, first.dot(off), -unbounded,
                  unbounded});
  rows.push_back({d, 0, 1, RowKind::anchor_across, second, place, second.dot(off), -unbounded,
                  unbounded});
  rows.push_back({d, 0, 2, RowKind::anchor_stop, at.outward, place, slack + along, 0.0, unbounded});
  rows.push_back({d, 0, 3, RowKind::anchor_stop, -at.outward, place, slack - along, 0.0,
                  unbounded});
}

Eigen::Index Coupling::path_column(const CouplingRow& row) const {
  return m_first_column[row.device] + 3 * Eigen::Index(row.point);
}

SparseColumns Coupling::path_columns(const Blocks& blocks) const {
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index column = 0;
  for (const InsertedDevice& device : m_devices) {
    for (const PathPoint& point : device.path) {
      for_each_tie_point(point, [&](Index tet, const Eigen::Vector4d& weights, double share) {
        const Interpolation at = m_mesh.interpolation(tet, weights);
        for (std::size_t a = 0; a < std::size_t(at.count); ++a) {
          const Index block = blocks.block_of()[std::size_t(at.nodes[a])];
          for (int k = 0; k < 3; ++k) {
            entries.emplace_back(3 * block + k, column + k, share * at.weights[a]);
          }
        }
      });
      column += 3;
    }
  }
  SparseColumns columns(3 * blocks.count(), column);
  columns.setFromTriplets(entries.begin(), entries.end());
  return columns;
}

Eigen::VectorXd Coupling::device_gradient(const CouplingRow& row,
                                          const std::vector<DeviceMotion>& motions) const {
  const InsertedDevice& device = m_devices[row.device];
  Eigen::VectorXd g = Eigen::VectorXd::Zero(device.beam.dof_count());
  g.segment<12>(6 * row.place.element) =
      -position_derivative(device.beam, motions[row.device].beam, row.place).transpose() *
      row.direction;
  hold(row.device, motions[row.device].beam, g);
  return g;
}

void Coupling::add_forces(const std::vector<CouplingRow>& rows,
                          const std::vector<DeviceMotion>& motions, Points& nodal,
                          DeviceVectors& on_devices) const {
  for (const CouplingRow& row : rows) {
    const double multiplier = multiplier_of(motions[row.device], row);
    on_devices[row.device] += multiplier * device_gradient(row, motions);
    if (row.kind == RowKind::anchor_across || row.one_sided()) continue;
    const PathPoint& point = m_devices[row.device].path[row.point];
    for_each_tie_point(point, [&](Index tet, const Eigen::Vector4d& weights, double share) {
      const Interpolation at = m_mesh.interpolation(tet, weights);
      for (std::size_t a = 0; a < std::size_t(at.count); ++a) {
        nodal.row(at.nodes[a]) += (share * multiplier * at.weights[a] * row.direction).transpose();
      }
    });
  }
}

// With g = n . (x - c(q)) at the foot of x and the tie closed, to second order along the steps that keep it
// closed: d2g = -2 (n . dt) ds - (n . c_ss) ds^2 - n . d2c, where ds = t . (dx - dc) moves the foot and
// d2c is that of the section at a fixed place. An anchored section has the last term alone.
std::vector<TieTurn> Coupling::turns(const std::vector<CouplingRow>& rows,
                                     const std::vector<DeviceMotion>& motions) const {
  std::vector<TieTurn> turns;
  for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
    const CouplingRow &first = rows[r], &second = rows[r + 1];
    if (first.kind != RowKind::across || first.axis != 0) continue;   // the second one follows it
    const InsertedDevice& device = m_devices[first.device];
    const BeamState& state = motions[first.device].beam;
    const Vec3 force = multiplier_of(motions[first.device], first) * first.direction +
                       multiplier_of(motions[first.device], second) * second.direction;
    TieTurn turn{first, Eigen::VectorXd::Zero(device.beam.dof_count()),
                 force.dot(brainshift::curvature(device.beam, state, first.place))};
    turn.slip.direction = unit_tangent(device.beam, state, first.place);
    turn.turn.segment<12>(6 * first.place.element) =
        unit_tangent_derivative(device.beam, state, first.place).transpose() * force;
    hold(first.device, state, turn.turn);
    if (turn.turn.squaredNorm() > 0.0) turns.push_back(std::move(turn));
  }
  return turns;
}

void Coupling::add_tangent(const std::vector<CouplingRow>& rows,
                           const std::vector<DeviceMotion>& motions, std::size_t d,
                           BlockTridiagonal& K) const {
  const Beam& beam = m_devices[d].beam;
  for (const CouplingRow& row : rows) {
    if (row.device != d) continue;
    const Vec3 force = multiplier_of(motions[d], row) * row.direction;
    K.add_element(row.place.element, position_hessian(beam, motions[d].beam, row.place, force));
  }
}

// The spin of a hinged anchor is held about the tangent it has now. A round wire turned about itself
// is the same wire, so that this hold carries nothing; one about an axis fixed in space would hold
// part of the slope, and let go of it only as the whole wire spins.
void Coupling::hold(std::size_t d, const BeamState& state, Eigen::VectorXd& v) const {
  for (Index dof : m_held[d]) v[dof] = 0.0;
  if (!m_devices[d].is_hinged()) return;
  const Index node = m_devices[d].anchor_node();
  const Vec3 axis = state.R[std::size_t(node)].col(0);
  v.segment<3>(6 * node + 3) -= axis.dot(v.segment<3>(6 * node + 3)) * axis;
}

void Coupling::hold(std::size_t d, const BeamState& state, BlockTridiagonal& K) const {
  for (Index dof : m_held[d]) K.fix(dof);
  if (!m_devices[d].is_hinged()) return;
  const Index node = m_devices[d].anchor_node();
  K.fix_spin(node, state.R[std::size_t(node)].col(0));
}

}  // namespace brainshift
