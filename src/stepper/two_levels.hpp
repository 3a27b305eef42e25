// The linearised problem of quadratic tets, solved by conjugate gradients with the factor of the linear tets
// for a second level. docs/theory.md (24)
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "linear/spd_solver.hpp"
#include "stepper/equilibrium.hpp"

namespace brainshift {

// The ends of the edge on which each node of a quadratic mesh lies, both the node itself at corners.
class EdgeEnds {
 public:
  explicit EdgeEnds(const Mesh& linear);
  std::pair<Index, Index> of(Index node) const { return m_of[std::size_t(node)]; }
  Points interpolated(const Points& corners) const;
  Points gathered(const Points& all, Index corner_count) const;  // its transpose

 private:
  std::vector<std::pair<Index, Index>> m_of;
};

// The tangent at a state, with the slopes of the fluid's heads. Contact rows are kept closed by a set.
class Tangent {
 public:
  Tangent(const Equilibrium& eq, const Points& u, const Forces& forces,
          const std::vector<double>& multipliers);
  // Contacts with a mark stay closed, the others are not there.
  void close(const std::vector<char>& contacts);

  const Reduction& reduction() const { return *m_reduction; }
  const BlockMatrix& reduced() const { return m_reduced; }

  // What a load leaves out of balance once the rows have their values.
  Eigen::VectorXd right_side(const Eigen::VectorXd& load) const;
  Eigen::VectorXd times(const Eigen::VectorXd& y) const;  // of the reduced unknowns
  // Multipliers of the contacts under a load and a motion of the blocks.
  std::vector<double> multipliers(const Eigen::VectorXd& load, const Eigen::VectorXd& dx) const;

 private:
  Eigen::VectorXd head_terms(const Eigen::VectorXd& dx) const;

  const Equilibrium& m_eq;
  const Points& m_u;
  const Forces& m_forces;
  std::optional<Reduction> m_reduction;
  BlockMatrix m_full, m_reduced;
  std::vector<Eigen::VectorXd> m_columns, m_rows;
};

// The factor of the linear tets.
class CoarseLevel {
 public:
  // Throws linear_solver where their tangent is not positive definite.
  CoarseLevel(const Equilibrium& eq, const Tangent& tangent, const EdgeEnds& ends);
  // Motions of all nodes of the quadratic mesh under forces on them.
  Points solve(const Points& forces) const;

 private:
  const Equilibrium& m_eq;
  const Tangent& m_tangent;
  const EdgeEnds& m_ends;
  std::unique_ptr<SpdSolver> m_solver;
};

struct TwoLevelSolution {
  Eigen::VectorXd y;   // of the reduced unknowns
  Eigen::VectorXd dx;  // of the blocks
  int iterations = 0;
  double residual = 0.0;  // relative to that of no motion, in the preconditioner's norm
};

// Goes on from a solution with the same contacts, or from no motion, to a tolerance of the residual.
// Throws linear_solver where the tangent is not positive definite or the iterations do not get through.
TwoLevelSolution solve_two_levels(const Equilibrium& eq, const Tangent& tangent,
                                  const CoarseLevel& coarse, const Eigen::VectorXd& load,
                                  double tolerance, TwoLevelSolution from = {});

}  // namespace brainshift
