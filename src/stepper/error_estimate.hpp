// By how much quadratic tets would move a state that linear ones have found.
//
// The scene is taken over to quadratic tets at the interpolated state u. What is out of balance there,
// r, moves them by w: one step of Newton's method towards the quadratic solution, K w = r with their
// tangent K and with the contacts that this problem closes: edge nodes and corners do not touch in the
// same places. It is found by conjugate gradients, preconditioned by the blocks of the nodes and by the
// linear tets' own factor (two levels): some tens of iterations for each change of the contacts,
// whatever the mesh. docs/theory.md (24)
#pragma once

#include "brainshift/stepper.hpp"
#include "coupling/coupling.hpp"
#include "stepper/equilibrium.hpp"

namespace brainshift {

struct LinearState {
  const Equilibrium& equilibrium;
  const Points& u;
  const std::vector<double>& multipliers;  // per contact row of the equilibrium
  const std::vector<InsertedDevice>& devices;
};

struct QuadraticCorrection {
  Mesh mesh;  // quadratic
  Points w;   // mm, per node
  int iterations = 0;
  double residual = 0.0;  // of the conjugate gradients, relative
};

// fine: the equilibrium of quadratic(scene) with the state's settings. Throws linear_solver where the
// tangent of either mesh is not positive definite there, or the iterations do not get through.
QuadraticCorrection quadratic_correction(const LinearState& state, const Equilibrium& fine);

}  // namespace brainshift
