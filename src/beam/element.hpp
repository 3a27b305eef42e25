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

using Vec6 = Eigen::Matrix<double, 6, 1>;
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
  double axial, torque;             // mN, mN mm
  double moment_a[2], moment_b[2];  // mN mm
};

// The forces of an element as unknowns of their own, for Newton's method. A device is so much stiffer
// against stretching than against bending that the stretch left by one linear step would rule the
// geometric stiffness of the next one; the forces the step itself predicts do not suffer from it.
// Equilibria are the same, the iterations to them fewer by tens.
struct ElementForces {
  double axial = 0.0;         // mN
  Vec6 local = Vec6::Zero();  // conjugate to chord, angles and twist: mN, mN mm
  // Derivatives of both by the dofs; for the gradient to fill.
  Vec12 axial_gradient = Vec12::Zero();
  Eigen::Matrix<double, 6, 12> local_gradient = Eigen::Matrix<double, 6, 12>::Zero();

  // From the forces at a pose to those after a step of the dofs, to first order.
  void predict(const Vec12& step) {
    axial += axial_gradient.dot(step);
    local += local_gradient * step;
  }
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
  double gradient(const ElementPose& pose, Vec12& gradient, Mat12& hessian) const {
    return gradient_and_hessian(pose, gradient, hessian, nullptr);
  }
  // The same with the geometric stiffness of the given forces, which are then replaced by those of
  // the pose, ready for predict().
  double mixed_gradient(const ElementPose& pose, ElementForces& forces, Vec12& gradient,
                        Mat12& hessian) const {
    return gradient_and_hessian(pose, gradient, hessian, &forces);
  }

  // Twist about the chord (rad), with the turns.
  static double twist(const ElementPose& pose);

  BeamResultants resultants(const ElementPose& pose) const;

 private:
  // Per axis of bending (d2, d3), from section and length.
  struct Bending {
    double curvature;                   // EI/L
    double phi;                         // 12 EI/(GA L^2)
    double mean_rest, difference_rest;  // of the slopes at the ends
  };
  double gradient_and_hessian(const ElementPose& pose, Vec12& gradient, Mat12& hessian,
                              ElementForces* forces) const;
  // Adds the shear that a torque causes in a bent element.
  template <class T>
  void add_shear_of_torque(const T& torque, const T* difference, T* gamma) const;
  // Energy without stretching, and the strain.
  template <class T>
  T local_energy(const T& chord, const T* slopes, const T& twist, T& strain) const;

  BeamSection m_section;
  double m_length = 0.0, m_chord_rest = 0.0, m_twist_rest = 0.0;
  double m_shortening_rest = 0.0, m_seen_twist_rest = 0.0;  // twist about the chord
  double m_bubble = 0.0;
  bool m_curved = false;  // at rest
  Bending m_bending[2];
};

}  // namespace brainshift
