// Newton's method on the whole contact problem: at every iteration the linearised problem with its
// one-sided rows is solved by a primal-dual active set, and an energy line search along the feasible
// way (nodes in contact slide on the curved surface) decides how far to go.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "brainshift/stepper.hpp"
#include "coupling/coupling.hpp"
#include "linear/spd_solver.hpp"
#include "stepper/backward_euler.hpp"
#include "stepper/equilibrium.hpp"
#include "stepper/linearised_tissue.hpp"
#include "stepper/turned_factor.hpp"

namespace brainshift {

// Matrices and factor that live as long as the pattern does.
struct FactorCache {
  std::shared_ptr<const Blocks> made_for;
  BlockMatrix stiffness, reduced;
  std::unique_ptr<SpdSolver> solver;

  // Makes them for this pattern, if they are for another.
  void prepare(const std::shared_ptr<const Blocks>& blocks, int threads);
};

// A force that balances what is out of balance when a solve begins, to be let go in steps.
struct Offset {
  Eigen::VectorXd tissue;   // on blocks, mN
  DeviceVectors devices;    // on dofs
};
Offset operator*(double factor, const Offset& offset);

class Newton {
 public:
  enum class Outcome { ongoing, converged, stuck, out_of_iterations, cancelled };

  // euler: inertia and damping of a step in time; none in statics.
  Newton(const Equilibrium& equilibrium, const Coupling& coupling, const StepperOptions& options,
         FactorCache& cache, SolveReport& report, const BackwardEuler* euler = nullptr);

  // Takes up the search for the balance of all forces plus `offset` (on blocks) from `start`:
  // ongoing, or converged where they are in balance there.
  Outcome begin(const MechanicalState& start, const Offset& offset, double load_factor);
  // The three parts of an iteration.
  void linearise();   // assembles the tangent, unless the factor at hand serves again
  void solve();       // the step: active set, factor, coupling; update() tells if there is none
  Outcome update();   // line search, the new iterate and what it is worth
  const MechanicalState& iterate() const { return m_state; }

  // Unbalanced force with the state's own multipliers; what fixed rows carry stays in.
  Offset unbalanced(const MechanicalState& state);
  // Fills the certificate of `report` for this state, without any offset; true: it holds.
  bool certify(const MechanicalState& state);
  // Fills in energies and the smallest det F of the iterate; returns the tet that has it.
  Eigen::Index describe();
  // After certify(): of that state, with the active set of the last step. Assembles and factorises only
  // where the last tangent was not positive definite; the factor at hand is lost then.
  Definiteness examine_tangent();
  // The tangent at the last iterate was not positive definite: a limit point or an instability.
  bool lost_stability() const { return m_lost_stability; }

 private:
  struct Step {
    Eigen::VectorXd dx;                 // on blocks
    std::vector<double> multipliers;    // per contact row
    DeviceVectors dq;                   // on the dofs of each device
    Eigen::VectorXd coupling;           // multiplier per coupling row
    Eigen::VectorXd pushed;             // those, and the forces of ties that turn
    double slope = 0.0;                 // force . step: what the energy falls by, to first order
    double predicted = 0.0;             // fall of the merit to first order, rows included
    double weight = 0.0;                // mN; of open ties in the merit
  };

  // A full step that raised the energy, taken because the next ones may lower it below what it was.
  struct Credit {
    MechanicalState from;
    double open = 0.0;   // uJ above the energy there
    int since = 0;       // iteration
  };

  void refresh();                                        // forces at m_state
  bool serves_again(bool was_fresh) const;
  bool may_turn() const;                                 // the factor at hand, for conjugate gradients
  bool unchanged(const MechanicalState& start) const;
  bool small_enough(double last_correction) const;
  void choose_active();
  void assemble();                                       // tangent at m_state
  void assemble_stiffness();                             // without the terms of the fluid
  bool factorise(const Reduction& reduction, bool singular);
  bool factorise_shifted(const Reduction& reduction, bool singular);
  bool flies(const Step& step) const;
  std::vector<NodeRow> rows_of(const std::vector<char>& active) const;
  bool make_ready(bool singular);
  void begin_iteration();
  bool serve();
  Step direction();
  void complete(Step& step, const Eigen::VectorXd& pushed) const;
  bool update_active(const Step& step);                  // true: the set changed
  bool find_step();
  bool find_step_by_turned_factor();
  Outcome go_on();
  Outcome blame();
  bool borrow(double change);
  void pay(double change);
  Outcome return_from_credit();
  Outcome take(double part, MechanicalState& next);
  double length_of_step(double part) const;
  double potential(const Forces& forces, const Points& u, const std::vector<DeviceMotion>& motions) const;
  double search(const Step& step, MechanicalState& next);
  void make_feasible(double part, Points& u, std::vector<char>& touched) const;
  void estimate_multipliers();
  void measure();
  Offset no_offset() const;
  bool factorise_devices();
  // Step of tissue and devices through their rows; adds the rows' force to `pushed`.
  void couple(Step& step, Eigen::VectorXd& pushed);
  struct Coupled;
  Coupled coupled_problem() const;
  void add_devices(Coupled& problem) const;
  bool solve_rows(const Coupled& problem, const DeviceVectors& loads, Step& step);
  void proximal_steps(const Coupled& problem, Step& step);
  void predict(Step& step) const;
  void refresh_devices();
  void move_devices(const Step& step, double part, MechanicalState& next) const;
  DeviceVectors coupled_device_load() const;
  double device_residual() const;
  void measure_coupling(double force_scale);
  double merit_of_rows(const MechanicalState& state, double weight) const;
  double device_energy(const std::vector<DeviceMotion>& motions) const;
  Eigen::VectorXd coupling_force() const;
  double local_stiffness(Index block) const;
  Vec3 free_part(Index block, const Vec3& direction) const;
  double mobility(std::size_t r) const;

  const Equilibrium& m_eq;
  const Coupling& m_coupling;
  const StepperOptions& m_options;
  FactorCache& m_cache;
  SolveReport& m_report;
  const BackwardEuler* m_euler;

  MechanicalState m_state;
  Forces m_forces;
  Points m_forces_at;                     // of which displacement they are
  Eigen::VectorXd m_inertia, m_damping;   // forces on blocks; of a step in time
  Offset m_offset;
  double m_load_factor = 1.0;
  Eigen::VectorXd m_load;               // external - internal + offset, on blocks; no rows
  DeviceVectors m_device_load;          // -gradient + offset, held dofs 0; no rows
  std::vector<CouplingRow> m_couplings;
  std::vector<BlockTridiagonalFactor> m_device_factors;
  DeviceVectors m_proximal;             // diagonal added to the tangents in them
  std::vector<char> m_active;           // per contact row
  std::vector<Mat3> m_free;             // per block: projection on what its fixed rows leave free
  std::optional<LinearisedTissue> m_linearised;
  std::optional<TurnedFactor> m_turned_factor;
  std::vector<char> m_factored;         // the active set of its factor
  std::optional<Reduction> m_reduction; // of the set in use
  Step m_step;
  bool m_found = false;                 // there is a step
  bool m_fresh = true;                  // the next iteration assembles and factorises
  bool m_turned = false;                // the next iteration assembles, and turns the factor at hand
  bool m_far_from_factor = false;       // a turned factor has been asked for a step since, which rounds it
  int m_turns_left = 0;                 // how many more may be too far away
  bool m_definite = false;              // with the projected tangent
  bool m_lost_stability = false;        // of the last tangent that was factored
  int m_iteration = 0;                  // since begin()
  double m_softest_scale = 0.0;   // mN; that of the residual, with the floor of the softest tissue
  double m_last = 0.0, m_previous = 0.0;   // mm; lengths of the last two steps
  bool m_may_borrow = false;
  std::optional<Credit> m_credit;
};

}  // namespace brainshift
