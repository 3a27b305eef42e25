// What a yardstick is taken on: bench/speed/kernels.cpp says what it is.
#pragma once

#include <memory>
#include <vector>

#include "linear/spd_solver.hpp"
#include "scene.hpp"
#include "stepper/equilibrium.hpp"

namespace bench {

using namespace dbs;

// A head at rest under the default options, its tangent, and a factor of it.
struct Rest {
  Options options;
  SceneIds ids;
  Equilibrium balance;
  Points u;
  Forces forces;
  std::vector<double> multipliers;
  BlockMatrix tangent;
  std::unique_ptr<SpdSolver> solver = make_spd_solver();

  explicit Rest(const Head& head)
      : balance(make_scene(head, options, ids)),
        u(Points::Zero(head.brain.node_count(), 3)),
        forces(balance.forces(u)),
        multipliers(balance.contacts().size(), 0.0),
        tangent(balance.blocks().make_matrix()) {
    balance.tangent(u, forces, multipliers, false, tangent);
    solver->analyse(tangent);
    if (!solver->factorise(tangent)) throw Error(ErrorCode::internal, "the head at rest is not stable");
  }
  Eigen::Index unknowns() const { return 3 * Eigen::Index(balance.blocks().count()); }
};

}  // namespace bench
