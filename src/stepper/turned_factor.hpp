// A factor of another iterate, turned with the tissue: the preconditioner Q A^-1 Q^T for conjugate gradients on
// the tangent of today, docs/theory.md (27).
#pragma once

#include <optional>
#include <vector>

#include "contact/blocks.hpp"
#include "contact/reduction.hpp"
#include "linear/spd_solver.hpp"

namespace brainshift {

class TurnedFactor {
 public:
  // All must outlive it.
  TurnedFactor(const Mesh& mesh, const Blocks& blocks, const BlockMatrix& K, SpdSolver& solver);

  // The solver has factored T^T K T of this reduction, at the displacement u.
  void take_factor(const Reduction& factored, const Points& u);
  // Motion of the blocks under `force` at the displacement u, with K of there, that obeys `rows`, those of the
  // factor as they are today: a tenth of the residual is left, in the norm of the preconditioner. None: that took
  // more than a factor is worth, or K is not positive there. Rounds the factor, which is of no use elsewhere then.
  std::optional<Eigen::VectorXd> step(const std::vector<NodeRow>& rows, const Points& u, const Eigen::VectorXd& force);

 private:
  std::vector<Mat3> rotations(const Points& u) const;   // per block
  Eigen::VectorXd solve(const Eigen::VectorXd& y) const;

  const Mesh& m_mesh;
  const Blocks& m_blocks;
  const BlockMatrix& m_K;
  SpdSolver& m_solver;
  std::optional<Reduction> m_factored;
  Points m_at;                         // displacement at the factor
  std::vector<Mat3> m_then, m_turns;   // per block: rotation at the factor, and from there to u
};

}  // namespace brainshift
