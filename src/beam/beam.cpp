#include "beam/beam.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "beam/centreline.hpp"
#include "beam/rotation.hpp"

namespace brainshift {

Beam::Beam(BeamDevice device, const Vec3& tip, const Mat3& orientation)
    : m_device(std::move(device)) {
  const Points& nodes = m_device.nodes();
  m_rest.x.resize(nodes.rows(), 3);
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    m_rest.x.row(i) = tip + orientation * (nodes.row(i) - nodes.row(0)).transpose();
    m_rest.R.push_back(orientation * m_device.frames()[std::size_t(i)]);
  }
  m_rest.turns.assign(std::size_t(element_count()), 0);
  for (Index e = 0; e < element_count(); ++e) {
    m_elements.emplace_back(m_device.section(e), pose(m_rest, e));
  }
}

double Beam::energy(const BeamState& state) const {
  double sum = 0.0;
  for (Index e = 0; e < element_count(); ++e) sum += element(e).energy(pose(state, e));
  return sum;
}

double Beam::assemble(const BeamState& state, Eigen::VectorXd& gradient, BlockTridiagonal& K,
                      std::vector<ElementForces>* forces) const {
  if (K.blocks() != node_count()) K = BlockTridiagonal(node_count());
  K.set_zero();
  gradient.setZero(dof_count());
  double sum = 0.0;
  Vec12 g;
  Mat12 H;
  for (Index e = 0; e < element_count(); ++e) {
    const ElementPose at = pose(state, e);
    sum += forces ? element(e).mixed_gradient(at, (*forces)[std::size_t(e)], g, H)
                  : element(e).gradient(at, g, H);
    gradient.segment<12>(6 * e) += g;
    K.add_element(e, H);
  }
  return sum;
}

void Beam::predict(std::vector<ElementForces>& forces, const Eigen::VectorXd& step) const {
  for (Index e = 0; e < element_count(); ++e) {
    forces[std::size_t(e)].predict(step.segment<12>(6 * e));
  }
}

void Beam::update(BeamState& state, const Eigen::VectorXd& step) const {
  constexpr double full_turn = 2.0 * 3.14159265358979323846;
  Eigen::VectorXd expected(element_count());  // twist if the spins were about the chord
  for (Index e = 0; e < element_count(); ++e) {
    const Vec3 chord = (state.x.row(e + 1) - state.x.row(e)).normalized();
    const Vec3 spin = step.segment<3>(6 * e + 9) - step.segment<3>(6 * e + 3);
    expected[e] = BeamElement::twist(pose(state, e)) + chord.dot(spin);
  }
  for (Index i = 0; i < node_count(); ++i) {
    state.x.row(i) += step.segment<3>(6 * i).transpose();
    Mat3& R = state.R[std::size_t(i)];
    R = orthonormalised(rotation_exp(step.segment<3>(6 * i + 3)) * R);
  }
  for (Index e = 0; e < element_count(); ++e) {
    int& turns = state.turns[std::size_t(e)];
    turns = 0;
    const double seen = BeamElement::twist(pose(state, e));
    const double missing = (expected[e] - seen) / full_turn;
    // a section folded back by half a turn shows none or a full one: take none
    turns = int(std::lround(missing - std::copysign(1e-6, missing)));
  }
}

BlockTridiagonal Beam::mass(const BeamState& state) const {
  // four Gauss points: exact for the product of two cubics
  constexpr double points[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                0.93056815579702629};
  constexpr double weights[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                 0.17392742256872693};
  BlockTridiagonal M(node_count());
  for (Index e = 0; e < element_count(); ++e) {
    const BeamSection& section = element(e).section();
    const double mass = section.line_density * element(e).length();
    const double polar = 0.5 * mass * section.radius * section.radius;
    Mat12 m = Mat12::Zero();
    for (int q = 0; q < 4; ++q) {
      const Mat3x12 N = position_derivative(*this, state, {e, points[q]});
      m.noalias() += (weights[q] * mass) * (N.transpose() * N);
    }
    // spins run linearly between the ends; moments of inertia (polar, polar/2, polar/2)
    const Vec3 axis = (state.x.row(e + 1) - state.x.row(e)).normalized();
    const Mat3 inertia = 0.5 * polar * (Mat3::Identity() + axis * axis.transpose());
    m.block<3, 3>(3, 3) += inertia / 3.0;
    m.block<3, 3>(9, 9) += inertia / 3.0;
    m.block<3, 3>(3, 9) += inertia / 6.0;
    m.block<3, 3>(9, 3) += inertia / 6.0;
    M.add_element(e, m);
  }
  return M;
}

Eigen::VectorXd Beam::node_masses() const {
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(node_count());
  for (Index e = 0; e < element_count(); ++e) {
    const double half = 0.5 * element(e).section().line_density * element(e).length();
    masses[e] += half;
    masses[e + 1] += half;
  }
  return masses;
}

Eigen::VectorXd Beam::weight(const Vec3& gravity) const {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(dof_count());
  for (Index e = 0; e < element_count(); ++e) {
    const double half = 0.5 * element(e).section().line_density * element(e).length();
    load.segment<3>(6 * e) += half * gravity;
    load.segment<3>(6 * e + 6) += half * gravity;
  }
  return load;
}

}  // namespace brainshift
