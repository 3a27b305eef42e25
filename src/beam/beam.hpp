// A beam in space: positions and rotations of the nodes of a device, its energy and tangent.
//
// Dofs: 6 per node, translation and spin (dx, t), x <- x + dx, R <- exp(t) R. Spins are never added
// up to a rotation vector, so no total rotation is too large; full turns of twist within an element
// are counted in the state.
#pragma once

#include <vector>

#include "beam/block_tridiagonal.hpp"
#include "beam/element.hpp"
#include "brainshift/beam_device.hpp"

namespace brainshift {

// All that moves. A plain value: copies are snapshots, bit by bit.
struct BeamState {
  Points x;                // N x 3, mm
  std::vector<Mat3> R;     // N; columns d1, d2, d3
  std::vector<int> turns;  // per element
};

class Beam {
 public:
  // The device at rest with its tip at `tip`, its own coordinates turned by `orientation`.
  Beam(BeamDevice device, const Vec3& tip, const Mat3& orientation);

  const BeamDevice& device() const { return m_device; }
  const BeamElement& element(Index e) const { return m_elements[std::size_t(e)]; }
  Index node_count() const { return m_device.node_count(); }
  Index element_count() const { return m_device.element_count(); }
  Index dof_count() const { return 6 * node_count(); }

  const BeamState& rest() const { return m_rest; }

  double energy(const BeamState& state) const;  // uJ
  // Returns the energy; gradient (minus the elastic force), 6N; K: its exact, symmetric derivative
  // along exp. At a node that carries an outer moment m (fixed in space), Newton's method on the
  // balance gradient = load needs K - skew(m)/2 in the rotations of that node.
  double tangent(const BeamState& state, Eigen::VectorXd& gradient, BlockTridiagonal& K) const {
    return assemble(state, gradient, K, nullptr);
  }
  // The same with the forces of the elements as unknowns of their own: see ElementForces.
  double mixed_tangent(const BeamState& state, std::vector<ElementForces>& forces,
                       Eigen::VectorXd& gradient, BlockTridiagonal& K) const {
    return assemble(state, gradient, K, &forces);
  }
  // Call it with the Newton step that is about to be taken.
  void predict(std::vector<ElementForces>& forces, const Eigen::VectorXd& step) const;

  // x <- x + dx, R <- exp(t) R; steps of any size, also many turns.
  void update(BeamState& state, const Eigen::VectorXd& step) const;

  // Consistent mass, with the rotary inertia of round sections. Zero for a weightless device.
  BlockTridiagonal mass(const BeamState& state) const;
  // Lumped translational mass, one per node: half of each element's (kg).
  Eigen::VectorXd node_masses() const;
  // Dead load of gravity (mm/s^2) on the nodes, 6N; half of each element to either end.
  Eigen::VectorXd weight(const Vec3& gravity) const;

  BeamResultants resultants(const BeamState& state, Index e) const {
    return element(e).resultants(pose(state, e));
  }

 private:
  double assemble(const BeamState& state, Eigen::VectorXd& gradient, BlockTridiagonal& K,
                  std::vector<ElementForces>* forces) const;
  ElementPose pose(const BeamState& state, Index e) const {
    const auto i = std::size_t(e);
    return {state.x.row(e), state.x.row(e + 1), state.R[i], state.R[i + 1], state.turns[i]};
  }

  BeamDevice m_device;
  BeamState m_rest;
  std::vector<BeamElement> m_elements;
};

}  // namespace brainshift
