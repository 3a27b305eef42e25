// Newton's method on the whole contact problem: at every iteration the linearised problem with its
// one-sided rows is solved by a primal-dual active set, and an energy line search along the feasible
// way (nodes in contact slide on the curved surface) decides how far to go.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "brainshift/stepper.hpp"
#include "linear/spd_solver.hpp"
#include "stepper/equilibrium.hpp"

namespace brainshift {

// Matrices and factor that live as long as the pattern does.
struct FactorCache {
  std::shared_ptr<const Blocks> made_for;
  BlockMatrix stiffness, reduced;
  std::unique_ptr<SpdSolver> solver;
};

// What changes in a solve: displacement, and multiplier per contact row.
struct MechanicalState {
  Points u;
  std::vector<double> multipliers;
};

class Newton {
 public:
  enum class Outcome { converged, stuck, out_of_iterations, cancelled };

  Newton(const Equilibrium& equilibrium, const StepperOptions& options, FactorCache& cache,
         SolveReport& report);

  // Finds the balance of all forces plus `offset` (on blocks) from `state`; on anything but
  // converged `state` is left as it was.
  Outcome solve(MechanicalState& state, const Eigen::VectorXd& offset, double load_factor);

  // Unbalanced force on blocks with the state's own multipliers; what fixed rows carry stays in.
  Eigen::VectorXd unbalanced(const MechanicalState& state);
  // Fills the certificate of `report` for this state.
  void certify(const MechanicalState& state, const Eigen::VectorXd& offset);

 private:
  struct Step {
    Eigen::VectorXd dx;                 // on blocks
    std::vector<double> multipliers;    // per contact row
    double slope = 0.0;                 // force . dx: what the energy falls by, to first order
  };

  void refresh(const Eigen::VectorXd& offset);           // forces at m_state.u
  bool small_enough(double last_correction) const;
  void choose_active();
  bool linearise();                                      // assemble, reduce, factorise
  bool factorise_shifted(const Reduction& reduction);
  Reduction make_reduction(const Reduction* like = nullptr) const;
  Step direction(const Reduction& reduction);
  bool update_active(const Step& step);                  // true: the set changed
  bool find_step(Step& step, bool fresh);
  double search(const Step& step, MechanicalState& next);
  bool no_new_inversion(const Points& u, const Eigen::VectorXd& before) const;
  void make_feasible(double part, Points& u, std::vector<char>& touched) const;
  void estimate_multipliers();
  void measure(const Eigen::VectorXd& offset);
  double local_stiffness(Index block) const;
  Vec3 free_part(Index block, const Vec3& direction) const;
  double mobility(std::size_t r) const;

  const Equilibrium& m_eq;
  const StepperOptions& m_options;
  FactorCache& m_cache;
  SolveReport& m_report;

  MechanicalState m_state;
  Forces m_forces;
  Eigen::VectorXd m_offset, m_load;     // m_load = external - internal + offset, on blocks
  std::vector<char> m_active;           // per contact row
  std::vector<Mat3> m_free;             // per block: projection on what its fixed rows leave free
  std::vector<RankOne> m_terms;
  std::vector<Eigen::VectorXd> m_columns, m_rows;   // the terms on blocks
  bool m_definite = false;
  std::optional<Reduction> m_factored;  // the one the factor at hand was made with
};

}  // namespace brainshift
