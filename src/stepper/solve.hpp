// One solve, from its begin to its end: the change of load is let go in steps, and each is brought
// into balance by Newton's method. Works on copies; the owner takes the result or throws it away.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "brainshift/stepper.hpp"
#include "coupling/coupling.hpp"
#include "stepper/backward_euler.hpp"
#include "stepper/newton.hpp"

namespace brainshift {

class Solve {
 public:
  // devices and options must outlive it. motion: of a step in time; none in statics.
  Solve(Equilibrium equilibrium, const std::vector<InsertedDevice>& devices, MechanicalState start,
        const StepperOptions& options, FactorCache& cache, const std::optional<Motion>& motion);
  Solve(const Solve&) = delete;  // its parts refer to each other
  Solve& operator=(const Solve&) = delete;

  // In this order, until update() ends the solve; see Stepper.
  void linearise();
  void solve();
  void update();

  StepPhase phase() const { return m_phase; }
  const SolveReport& report() const { return m_report; }
  double& seconds() { return m_report.seconds; }  // spent in its phases
  const Points& iterate() const { return m_newton.iterate().u; }
  void fail_by_exception(const char* call) noexcept;  // one has ended it

  bool is_static() const { return !m_euler; }
  // What converged. Velocities are zero in statics.
  const MechanicalState& result() const { return m_balanced; }
  // The last balance on the way of a solve that has failed; it is gone from here then.
  Farthest take_farthest() noexcept { return {m_report.load_factor, std::move(m_balanced.u)}; }
  Points velocity() const;
  Equilibrium& equilibrium() { return m_equilibrium; }

 private:
  void refuse_start();
  Newton::Outcome begin_load_step();
  void settle(Newton::Outcome outcome);
  bool halve_load_step(Newton::Outcome outcome);
  std::string hint(bool stuck) const;
  std::string remark() const;
  bool is_late() const;
  void finish();
  void fail(const std::string& message);

  const StepperOptions& m_options;
  Equilibrium m_equilibrium;
  Coupling m_coupling;
  std::optional<BackwardEuler> m_euler;
  SolveReport m_report;
  Newton m_newton;

  MechanicalState m_balanced;  // at the part of the load that has been let go
  Offset m_unbalanced;         // what was out of balance at the begin
  double m_reached = 0.0, m_next = 0.0, m_step = 1.0;  // parts of the load
  StepPhase m_phase = StepPhase::begun;
  const std::chrono::steady_clock::time_point m_begin = std::chrono::steady_clock::now();
};

}  // namespace brainshift
