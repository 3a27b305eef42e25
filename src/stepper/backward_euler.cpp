#include "stepper/backward_euler.hpp"

namespace brainshift {
namespace {

// Sum of m |v|^2.
double weighted(const Eigen::VectorXd& masses, const Points& v) {
  return masses.dot(v.rowwise().squaredNorm());
}

}  // namespace

BackwardEuler::BackwardEuler(const Equilibrium& equilibrium, const Coupling& coupling,
                             const MechanicalState& start, const Motion& motion)
    : m_eq(equilibrium),
      m_start(start),
      m_motion(motion),
      m_masses(equilibrium.tissue().node_masses()) {
  for (const InsertedDevice& d : coupling.devices()) {
    m_device_masses.push_back(d.beam.node_masses());
  }
  if (motion.damping.beta == 0.0) return;
  m_stiffness = m_eq.blocks().make_matrix();
  m_eq.stored_tangent(start.u, true, m_stiffness);
}

Points BackwardEuler::velocity(std::size_t d, const BeamState& beam) const {
  return (beam.x - m_start.devices[d].beam.x) / m_motion.dt;
}

double BackwardEuler::potential(const Points& u, const std::vector<DeviceMotion>& devices) const {
  const double drag = m_motion.dt * m_motion.damping.alpha;
  const Points v = velocity(u);
  double sum = weighted(m_masses, v - m_motion.velocity) + drag * weighted(m_masses, v);
  if (m_stiffness.blocks() > 0) {
    const Eigen::VectorXd motion = m_eq.blocks().gather_motion(v);
    Eigen::VectorXd force;
    m_stiffness.multiply(motion, force);
    sum += m_motion.dt * m_motion.damping.beta * motion.dot(force);
  }
  for (std::size_t d = 0; d < devices.size(); ++d) {
    const Points w = velocity(d, devices[d].beam);
    sum += weighted(m_device_masses[d], w - m_start.devices[d].velocity) +
           drag * weighted(m_device_masses[d], w);
  }
  return 0.5 * sum;
}

double BackwardEuler::kinetic_energy(const Points& u,
                                     const std::vector<DeviceMotion>& devices) const {
  double sum = weighted(m_masses, velocity(u));
  for (std::size_t d = 0; d < devices.size(); ++d) {
    sum += weighted(m_device_masses[d], velocity(d, devices[d].beam));
  }
  return 0.5 * sum;
}

Eigen::VectorXd BackwardEuler::inertia(const Points& u) const {
  const Points acceleration = (velocity(u) - m_motion.velocity) / m_motion.dt;
  return m_eq.blocks().gather(-(m_masses.asDiagonal() * acceleration));
}

Eigen::VectorXd BackwardEuler::damping(const Points& u) const {
  const Points v = velocity(u);
  Eigen::VectorXd force =
      m_eq.blocks().gather(-m_motion.damping.alpha * (m_masses.asDiagonal() * v));
  if (m_stiffness.blocks() > 0) {
    Eigen::VectorXd product;
    m_stiffness.multiply(m_eq.blocks().gather_motion(v), product);
    force -= m_motion.damping.beta * product;
  }
  return force;
}

void BackwardEuler::add_tangent(BlockMatrix& K) const {
  const double dt = m_motion.dt;
  const double per_mass = (1.0 / dt + m_motion.damping.alpha) / dt;
  const Indices& block_of = m_eq.blocks().block_of();
  for (Eigen::Index i = 0; i < m_masses.size(); ++i) {
    K.add(K.slot_at(block_of[std::size_t(i)], 0), per_mass * m_masses[i] * Mat3::Identity());
  }
  if (m_stiffness.blocks() > 0) K.add(m_stiffness, m_motion.damping.beta / dt);
}

void BackwardEuler::add_force(std::size_t d, const BeamState& beam, Eigen::VectorXd& load) const {
  const Points v = velocity(d, beam);
  const Points rate = (v - m_start.devices[d].velocity) / m_motion.dt + m_motion.damping.alpha * v;
  for (Eigen::Index i = 0; i < rate.rows(); ++i) {
    load.segment<3>(6 * i) -= m_device_masses[d][i] * rate.row(i).transpose();
  }
}

void BackwardEuler::add_tangent(std::size_t d, BlockTridiagonal& K) const {
  const double per_mass = (1.0 / m_motion.dt + m_motion.damping.alpha) / m_motion.dt;
  for (Index i = 0; i < K.blocks(); ++i) {
    K.diagonal(i).diagonal().head<3>().array() += per_mass * m_device_masses[d][i];
  }
}

}  // namespace brainshift
