// One beam element: energy with exact gradient and Hessian. docs/decisions/beam-element.md
//
// Each end carries a section frame (d1 along the beam, d2, d3 across). The element sees six numbers
// that no rigid motion changes: its chord, the angles (two components each) from either section
// normal to the chord, and the twist of one section against the other about the chord. They enter an
// energy that is quadratic in curvature and exact to second order in the angles: the shortening of
// the chord by bending (P-delta) and the twist that a space curve carries (writhe) are in it.
#pragma once

#include "beam/block_tridiagonal.hpp"
#include "brainshift/beam_device.hpp"

namespace brainshift {

using Vec12 = Eigen::Matrix<double, 12, 1>;

// Where the two ends are. R: columns d1, d2, d3. `turns`: full turns of twist to be added to what
// the frames show (they show it in (-pi, pi]).
struct ElementPose {
  Vec3 xa, xb;
  const Mat3 &Ra, &Rb;
  int turns;
};

// What an element carries; the moments are those in the planes (d1, d2) and (d1, d3) of its mean
// section, positive when they bend d1 towards d2 or d3 on the way from a to b.
struct BeamResultants {
  double axial, torque;           // mN, mN mm
  double moment_a[2], moment_b[2];  // mN mm
};

class BeamElement {
 public:
  // The pose at rest is free of load, whatever its angles.
  BeamElement(const BeamSection& section, const ElementPose& rest);

  double length() const { return m_length; }  // rest length of the centreline, mm
  const BeamSection& section() const { return m_section; }

  double energy(const ElementPose& pose) const;  // uJ
  // Dofs: translation and spin of either end, (dxa, ta, dxb, tb) with R <- exp(t) R; the Hessian is
  // the second derivative along exp, hence symmetric everywhere.
  double gradient(const ElementPose& pose, Vec12& gradient, Mat12& hessian) const;

  // Twist about the chord (rad), with the turns.
  static double twist(const ElementPose& pose);

  BeamResultants resultants(const ElementPose& pose) const;

 private:
  // Per axis of bending (d2, d3), from section and length.
  struct Bending {
    double curvature;  // EI/L
    double mean;       // 12 EI/(L (1 + phi)^2), phi = 12 EI/(GA L^2)
    double phi;
    double mean_rest, difference_rest;  // of the slopes at the ends
  };
  template <class T>
  T local_energy(const T& chord, const T* slopes, const T& twist) const;

  BeamSection m_section;
  double m_length = 0.0, m_chord_rest = 0.0, m_twist_rest = 0.0;
  Bending m_bending[2];
};

}  // namespace brainshift
