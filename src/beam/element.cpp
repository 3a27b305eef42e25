#include "beam/element.hpp"

#include <cmath>

#include "beam/element_measures.hpp"

namespace brainshift {

BeamElement::BeamElement(const BeamSection& section, const ElementPose& rest) : m_section(section) {
  const auto m = measure<Plain>(rest);
  double slopes[4];
  mean_axes(m.angles, m.twist, slopes);
  double shortening = 0.0;  // of the chord against the centreline, per length
  for (int i = 0; i < 2; ++i) {
    Bending& b = m_bending[i];
    b.mean_rest = 0.5 * (slopes[i] + slopes[2 + i]);
    b.difference_rest = slopes[2 + i] - slopes[i];
    shortening += b.mean_rest * b.mean_rest / 10.0 + b.difference_rest * b.difference_rest / 24.0;
  }
  m_chord_rest = m.chord;
  m_shortening_rest = shortening;
  m_seen_twist_rest = m.twist;
  // beyond the rounding of a straight device that is turned
  m_curved = std::hypot(m_bending[0].difference_rest, m_bending[1].difference_rest) > 1e-9;
  m_length = m.chord / (1.0 - shortening);
  const double stiffness[2] = {section.bending_2, section.bending_3};
  for (int i = 0; i < 2; ++i) {
    Bending& b = m_bending[i];
    b.curvature = stiffness[i] / m_length;
    b.phi = 12.0 * stiffness[i] / (section.shear * m_length * m_length);
    if (b.phi < 1e-20) b.phi = 0.0;  // no shear: far below rounding, and 1/phi must not overflow
  }
  const double n2 = -m_bending[1].difference_rest, n3 = m_bending[0].difference_rest;
  m_bubble = 0.5 / (12.0 * section.torsion / m_length + m_bending[0].curvature * n2 * n2 +
                    m_bending[1].curvature * n3 * n3);
  m_twist_rest = m.twist + 0.5 * (m_bending[0].mean_rest * m_bending[1].difference_rest -
                                  m_bending[1].mean_rest * m_bending[0].difference_rest);
}

// In a bent element the torque does work on shear, through gamma x d in the torsion: the curvature
// changes along a bent rod by torque as well as by shear force (balance of moments m' + r' x n = 0,
// Antman, Nonlinear Problems of Elasticity, chapter 8). The energy is least as a function of gamma at
//   12 EI/L (s_m - rest + gamma) + GA L gamma + torque (d_3, -d_2) = 0.
// Without the last term the shear of a rod that is bent and twisted is wrong by its torque times
// curvature over GA, on any mesh of elements longer than (12 EI/GA)^1/2.
template <class T>
void BeamElement::add_shear_of_torque(const T& torque, const T* difference, T* gamma) const {
  const auto give = [](const Bending& b) { return b.phi / ((1.0 + b.phi) * 12.0 * b.curvature); };
  gamma[0] -= torque * difference[1] * give(m_bending[0]);
  gamma[1] += torque * difference[0] * give(m_bending[1]);
}

// The deflection between the ends is the cubic of a beam with shear; s are the slopes of the
// *sections*, g = s + gamma those of the centreline. With mean m and difference d of the ends:
//   strain  = chord/L + sum (g_m^2/5 + d^2/12)/2 - gamma^2/2, against rest
//   torsion = twist + (s_m x d)/2 + gamma x d, against rest
//   gamma   = -phi/(1+phi) (s_m - rest), then the part of the torque (add_shear_of_torque)
// Rest curvature turns with the sections: twisted by t more than at rest, an element has the rest
// slopes d (1 - t^2/24) and s_m + t (d1 x d)/12.
template <class T>
T BeamElement::local_energy(const T& chord, const T* slopes, const T& twist, T& strain) const {
  T mean[2], difference[2], bent[2], sheared[2], gamma[2] = {0.0, 0.0};
  strain = (chord - m_chord_rest) * (1.0 / m_length);
  T energy = 0.0;
  const double rest_turned[2] = {-m_bending[1].difference_rest, m_bending[0].difference_rest};
  for (int i = 0; i < 2; ++i) {
    const Bending& b = m_bending[i];
    mean[i] = (slopes[i] + slopes[2 + i]) * 0.5;
    difference[i] = slopes[2 + i] - slopes[i];
    bent[i] = difference[i] - b.difference_rest;
    sheared[i] = mean[i] - b.mean_rest;
    if (m_curved) {
      bent[i] +=
          (twist * twist - m_seen_twist_rest * m_seen_twist_rest) * (b.difference_rest / 24.0);
      sheared[i] -= (twist - m_seen_twist_rest) * (rest_turned[i] / 12.0);
    }
    if (b.phi > 0.0) gamma[i] = sheared[i] * (-b.phi / (1.0 + b.phi));
  }
  const bool shear = m_bending[0].phi > 0.0;
  const double torsion_stiffness = m_section.torsion / m_length;
  const auto torsion = [&] {
    const T x = mean[0] * 0.5 + gamma[0], y = mean[1] * 0.5 + gamma[1];
    return twist + x * difference[1] - y * difference[0] - m_twist_rest;
  };
  if (shear) add_shear_of_torque(torsion() * torsion_stiffness, difference, gamma);
  for (int i = 0; i < 2; ++i) {
    const Bending& b = m_bending[i];
    const T g = mean[i] + gamma[i], linear = sheared[i] + gamma[i];
    energy += linear * linear * (6.0 * b.curvature);
    if (shear) {
      // Reissner's strains are the sine and cosine of the angle of shear, times the stretch
      const T sine =
          gamma[i] - (gamma[0] * gamma[0] + gamma[1] * gamma[1]) * gamma[i] * (1.0 / 6.0);
      const T stretched = chord * sine * (1.0 / m_chord_rest);
      strain -= gamma[i] * gamma[i] * 0.5;
      energy += stretched * stretched * (6.0 * b.curvature / b.phi);
    }
    strain += g * g * 0.1 + difference[i] * difference[i] * (1.0 / 24.0);
  }
  strain = strain - m_shortening_rest;
  const T twisted = torsion();
  energy += twisted * twisted * (0.5 * torsion_stiffness);
  if (shear) {
    // Section normals away from the chord by gamma: d is that much longer on the map of angles than
    // on the sphere of directions. Small, but bending energy may be large beside that of shear.
    const T across = gamma[0] * difference[1] - gamma[1] * difference[0];
    bent[0] += across * gamma[1] * (1.0 / 6.0);
    bent[1] -= across * gamma[0] * (1.0 / 6.0);
  }
  for (int i = 0; i < 2; ++i) energy += bent[i] * bent[i] * (0.5 * m_bending[i].curvature);
  if (m_curved) {
    const T torque = bent[0] * (m_bending[0].curvature * rest_turned[0]) +
                     bent[1] * (m_bending[1].curvature * rest_turned[1]);
    energy -= torque * torque * m_bubble;
  }
  return energy;
}

double BeamElement::energy(const ElementPose& pose) const {
  const auto m = measure<Plain>(pose);
  double slopes[4];
  mean_axes(m.angles, m.twist, slopes);
  double strain = 0.0;
  const double rest = local_energy(m.chord, slopes, m.twist, strain);
  return rest + 0.5 * m_section.axial * m_length * strain * strain;
}

double BeamElement::twist(const ElementPose& pose) { return measure<Plain>(pose).twist; }

namespace {

// Gradient and Hessian in (r, ta, tb), r = xb - xa, to those in (xa, ta, xb, tb).
Vec12 on_dofs(const Jet9::Gradient& g) {
  Vec12 v;
  v << -g.head<3>(), g.segment<3>(3), g.head<3>(), g.tail<3>();
  return v;
}

void on_dofs(const Jet9::Hessian& H, Mat12& K) {
  constexpr struct {
    int to, from;
    double sign;
  } parts[] = {{0, 0, -1.0}, {3, 3, 1.0}, {6, 0, 1.0}, {9, 6, 1.0}};
  for (const auto& i : parts) {
    for (const auto& j : parts) {
      K.block<3, 3>(i.to, j.to) = (i.sign * j.sign) * H.block<3, 3>(i.from, j.from);
    }
  }
}

}  // namespace

double BeamElement::gradient_and_hessian(const ElementPose& pose, Vec12& gradient, Mat12& hessian,
                                         ElementForces* forces) const {
  // Two levels, so that the long polynomial is differentiated in six variables instead of nine.
  const auto m = measure<Differentiated>(pose);
  const Jet9* outer[6] = {&m.chord,     &m.angles[0], &m.angles[1],
                          &m.angles[2], &m.angles[3], &m.twist};
  Jet<6> inner[6], slopes[4], strain;
  for (int k = 0; k < 6; ++k) inner[k] = Jet<6>::variable(outer[k]->v, k);
  mean_axes(inner + 1, inner[5], slopes);
  const Jet<6> energy = local_energy(inner[0], slopes, inner[5], strain);
  const double tension = m_section.axial * strain.v;
  const double carried = forces ? forces->axial : tension;  // what the geometric stiffness sees
  const Vec6 local_forces = energy.g + (m_length * tension) * strain.g;
  const Vec6 carried_forces = forces ? forces->local : local_forces;

  Eigen::Matrix<double, 9, 6> B;
  Jet9::Hessian H = Jet9::Hessian::Zero();
  for (int k = 0; k < 6; ++k) {
    B.col(k) = outer[k]->g;
    H += carried_forces[k] * outer[k]->h;
  }
  Jet<6>::Hessian local = energy.h + (m_length * carried) * strain.h;
  local.noalias() += (m_length * m_section.axial * strain.g) * strain.g.transpose();
  const Eigen::Matrix<double, 9, 6> BK = B * local;
  H.noalias() += BK * B.transpose();

  gradient = on_dofs(B * local_forces);
  on_dofs(H, hessian);
  if (forces) {
    forces->axial = tension;
    forces->axial_gradient = on_dofs(B * (m_section.axial * strain.g));
    forces->local = local_forces;
    for (int k = 0; k < 6; ++k) forces->local_gradient.row(k) = on_dofs(BK.col(k)).transpose();
  }
  return energy.v + 0.5 * m_length * tension * strain.v;
}

BeamResultants BeamElement::resultants(const ElementPose& pose) const {
  const auto m = measure<Plain>(pose);
  double start[4];
  mean_axes(m.angles, m.twist, start);
  Jet<6> inner[6];  // chord, slopes, twist
  inner[0] = Jet<6>::variable(m.chord, 0);
  for (int k = 0; k < 4; ++k) inner[k + 1] = Jet<6>::variable(start[k], k + 1);
  inner[5] = Jet<6>::variable(m.twist, 5);
  Jet<6> strain, energy = local_energy(inner[0], inner + 1, inner[5], strain);
  energy.g += (m_section.axial * m_length * strain.v) * strain.g;
  return {energy.g[0], energy.g[5], {-energy.g[1], -energy.g[2]}, {energy.g[3], energy.g[4]}};
}

}  // namespace brainshift
