// The matrix that a solve of a scene factors first, for bare factors beside whole solves.
#pragma once

#include "contact/reduction.hpp"
#include "stepper/equilibrium.hpp"

namespace bench {

inline brainshift::BlockMatrix stiffness_at_rest(const brainshift::Scene& scene) {
  const brainshift::Equilibrium balance(scene);
  brainshift::BlockMatrix K = balance.blocks().make_matrix(), A = K;
  const brainshift::Points u = brainshift::Points::Zero(scene.mesh.node_count(), 3);
  balance.tangent(u, balance.forces(u), {}, false, K);
  brainshift::Reduction(balance.blocks().count(), balance.fixed_rows()).reduce(K, K.mean_diagonal(), A);
  return A;
}

}  // namespace bench
