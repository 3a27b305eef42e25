// Equilibrium of a beam alone under dead loads: the shape of a device before it meets tissue, and
// what the verification cases run on.
#pragma once

#include <vector>

#include "beam/beam.hpp"

namespace brainshift {

struct BeamLoad {
  Eigen::VectorXd force;        // 6N: dead forces (mN) and moments fixed in space (mN mm)
  std::vector<Index> fixed;     // dofs that stay where they are
};

struct BeamStaticsOptions {
  int load_steps = 1;           // the load grows from what it was in equal steps
  int max_iterations = 200;     // per load step
  double tolerance = 1e-11;     // of the residual, relative to the stiffness (see `residual` below)
};

struct BeamStaticsReport {
  bool converged = false;
  int iterations = 0;
  double residual = 0.0;        // largest Newton correction left, in units of an element's length
};

// Newton's method from `state` at load `from` (6N, or empty: none) to the full load. Forces alone
// have an energy: the line search descends on it and stops only in a minimum. Moments fixed in space
// have none (they are not conservative): the search then looks at the residual. On failure `state` is
// the last load step that converged.
BeamStaticsReport solve_statics(const Beam& beam, const BeamLoad& load, BeamState& state,
                                const BeamStaticsOptions& options = {},
                                const Eigen::VectorXd& from = {});

}  // namespace brainshift
