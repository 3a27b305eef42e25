// Equilibrium of a beam alone under dead loads: the shape of a device before it meets tissue, and
// what the verification cases run on.
#pragma once

#include <vector>

#include "beam/beam.hpp"

namespace brainshift {

struct BeamLoad {
  Eigen::VectorXd force;     // 6N: dead forces (mN) and moments fixed in space (mN mm)
  std::vector<Index> fixed;  // dofs that stay where they are
};

struct BeamStaticsOptions {
  int load_steps = 1;        // the load grows from where it was in equal steps, halved where
                             // one does not converge
  int max_iterations = 200;  // per load step
  double tolerance = 1e-11;  // largest correction left: translations by the length, and spins
};

struct BeamStaticsReport {
  bool converged = false;
  int iterations = 0;       // of all load steps
  double correction = 0.0;  // the last one, as `tolerance` measures it; above it when rounding
                            // leaves no better (stiff against stretching, soft against bending)
};

// Newton's method from `state`, the equilibrium for the load `from` (6N; empty: none), to the full
// load. With the forces of the elements as unknowns first; where that ends in an equilibrium that is
// not a minimum, or in none with small steps either, by an energy line search, which ends only in a
// minimum. Moments fixed in space have no energy: then the former alone, and any equilibrium. On
// failure `state` is that of the last load step that converged.
BeamStaticsReport solve_statics(const Beam& beam, const BeamLoad& load, BeamState& state,
                                const BeamStaticsOptions& options = {},
                                const Eigen::VectorXd& from = {});

}  // namespace brainshift
