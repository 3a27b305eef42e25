// Inertia and Rayleigh damping of one step of backward Euler as an incremental potential, so that
// the search for u1 is a minimisation like that of statics (docs/theory.md (10) to (13)):
//   D(u) = 1/2 |v - v0|_M^2 + dt/2 |v|_C^2,   v = (u - u0) / dt,   C = alpha M + beta K0.
// M is lumped at the nodes. K0 is the tangent of the energy stored in tissue and supports at u0, each
// tet's projected on its nearest positive semidefinite one: damping never drives. Devices have mass
// where their sections have a line density, and alpha acts on it; beta does not.
#pragma once

#include <vector>

#include "coupling/coupling.hpp"
#include "stepper/equilibrium.hpp"
#include "stepper/mechanical_state.hpp"

namespace brainshift {

struct Motion {
  double dt;  // s
  Damping damping;
  Points velocity;  // N x 3, mm/s; when the step begins
};

class BackwardEuler {
 public:
  BackwardEuler(const Equilibrium& equilibrium, const Coupling& coupling,
                const MechanicalState& start, const Motion& motion);

  Points velocity(const Points& u) const { return (u - m_start.u) / m_motion.dt; }
  Points velocity(std::size_t d, const BeamState& beam) const;

  double potential(const Points& u, const std::vector<DeviceMotion>& devices) const;       // uJ
  double kinetic_energy(const Points& u, const std::vector<DeviceMotion>& devices) const;  // uJ

  // Forces on blocks (mN), together -dD/du; and the tangent of D added to K.
  Eigen::VectorXd inertia(const Points& u) const;
  Eigen::VectorXd damping(const Points& u) const;
  void add_tangent(BlockMatrix& K) const;

  // The same for the dofs of device d; both kinds of force at once.
  void add_force(std::size_t d, const BeamState& beam, Eigen::VectorXd& load) const;
  void add_tangent(std::size_t d, BlockTridiagonal& K) const;

 private:
  const Equilibrium& m_eq;
  MechanicalState m_start;
  Motion m_motion;
  Eigen::VectorXd m_masses;                      // kg per mesh node
  std::vector<Eigen::VectorXd> m_device_masses;  // kg per device node
  BlockMatrix m_stiffness;                       // K0; empty without beta
};

}  // namespace brainshift
