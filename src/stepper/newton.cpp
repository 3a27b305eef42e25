#include "stepper/newton.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace brainshift {
namespace {

class Stopwatch {
 public:
  explicit Stopwatch(double& total) : m_total(total), m_start(clock::now()) {}
  ~Stopwatch() { m_total += std::chrono::duration<double>(clock::now() - m_start).count(); }

 private:
  using clock = std::chrono::steady_clock;
  double& m_total;
  clock::time_point m_start;
};

double max_norm(const Eigen::VectorXd& v) { return v.size() ? v.lpNorm<Eigen::Infinity>() : 0.0; }

// Changes of the active set within one linearisation; more are left to the next iteration.
constexpr int max_active_set_changes = 4;
// Part of the body's diameter within which obstacles are looked for in one such change.
constexpr double reach_of_a_step = 0.01;

}  // namespace

Newton::Newton(const Equilibrium& equilibrium, const Coupling& coupling,
               const StepperOptions& options, FactorCache& cache, SolveReport& report)
    : m_eq(equilibrium),
      m_coupling(coupling),
      m_options(options),
      m_cache(cache),
      m_report(report),
      m_offset(no_offset()) {
  const auto& blocks = m_eq.blocks_pointer();
  m_free.assign(std::size_t(blocks->count()), Mat3::Identity());
  for (const NodeRow& row : m_eq.fixed_rows()) {
    Mat3& free = m_free[std::size_t(row.block)];
    const Vec3 left = free * row.normal;
    if (left.squaredNorm() > 1e-12) free -= left * left.transpose() / left.squaredNorm();
  }
  if (m_cache.made_for == blocks) return;
  m_cache.made_for.reset();  // of no pattern, should one of the next lines throw
  m_cache.stiffness = blocks->make_matrix();
  m_cache.reduced = m_cache.stiffness;
  m_cache.solver = make_spd_solver();
  m_cache.solver->analyse(m_cache.reduced);
  m_cache.made_for = blocks;
}

void Newton::refresh() {
  Stopwatch watch(m_report.seconds_assembly);
  m_forces = m_eq.forces(m_state.u);
  m_load = m_eq.blocks().gather(m_forces.external - m_forces.internal) + m_offset.tissue;
  refresh_devices();
}

// What the fixed rows of a block leave of a direction.
Vec3 Newton::free_part(Index block, const Vec3& direction) const {
  return m_free[std::size_t(block)] * direction;
}

// Change of a contact row's gap for a unit push along it; 0 where fixed rows hold both sides: such
// a row can do nothing and is left out.
double Newton::mobility(std::size_t r) const {
  const ContactRow& row = m_eq.contacts().row(r);
  const Vec3& n = m_forces.gaps[r].normal;
  double sum = n.dot(free_part(row.node, n));
  if (row.partner >= 0) sum += n.dot(free_part(row.partner, n));
  return sum > 1e-12 * n.squaredNorm() ? sum : 0.0;
}

double Newton::local_stiffness(Index block) const {
  return m_cache.stiffness.get(m_cache.stiffness.slot_at(block, 0)).trace() / 3.0;
}

// Primal-dual prediction: a row is active where its multiplier outweighs its gap, both as forces.
void Newton::choose_active() {
  const ContactRows& contacts = m_eq.contacts();
  m_active.assign(contacts.size(), 0);
  for (std::size_t r = 0; r < contacts.size(); ++r) {
    if (mobility(r) == 0.0) continue;
    const double stiffness = local_stiffness(contacts.row(r).node);
    m_active[r] = m_state.multipliers[r] - stiffness * m_forces.gaps[r].gap > 0.0;
  }
}

Reduction Newton::make_reduction(const Reduction* like) const {
  std::vector<NodeRow> rows = m_eq.fixed_rows();
  const std::size_t untagged = m_active.size();   // multipliers of fixed rows are not kept
  const Points& u = m_state.u;
  for (NodeRow& row : rows) {
    row.value = -row.normal.dot(u.row(Eigen::Index(row.tag)).transpose());
    row.tag = untagged;
  }
  for (int pass = 0; pass < 2; ++pass) {   // rows of one node first, then pairs
    for (std::size_t r = 0; r < m_active.size(); ++r) {
      const ContactRow& row = m_eq.contacts().row(r);
      if (!m_active[r] || (row.partner >= 0) != (pass == 1)) continue;
      rows.push_back({row.node, row.partner, m_forces.gaps[r].normal, -m_forces.gaps[r].gap, r});
    }
  }
  return Reduction(m_eq.blocks().count(), rows, like);
}

bool Newton::factorise_shifted(const Reduction& reduction) {
  Stopwatch watch(m_report.seconds_factor);
  const double scale = m_cache.stiffness.mean_diagonal();
  double shift = 0.0;
  for (int attempt = 0; attempt < 12; ++attempt) {
    ++m_report.factorisations;
    if (m_cache.solver->factorise(m_cache.reduced)) return true;
    ++m_report.shifted_factorisations;
    const double more = shift == 0.0 ? 1e-3 * scale : shift;   // doubles the shift
    m_cache.stiffness.add_to_diagonal(more);
    shift += more;
    reduction.reduce(m_cache.stiffness, scale, m_cache.reduced);
  }
  return false;
}

// Assembles the tangent; definite where a former one of this solve was not positive.
void Newton::linearise() {
  Stopwatch watch(m_report.seconds_assembly);
  m_eq.tangent(m_state.u, m_forces, m_state.multipliers, m_definite, m_cache.stiffness);
  m_terms = m_eq.head_terms(m_state.u, m_forces);
  m_columns.clear();
  m_rows.clear();
  for (const RankOne& term : m_terms) {
    m_columns.push_back(m_eq.blocks().gather(term.column));
    m_rows.push_back(m_eq.blocks().gather(term.row));
  }
}

// Solves (K + sum column row^T) y = T^T force for each column, on the admissible directions
// (Sherman, Morrison, Woodbury); the answer is expanded to motions of the blocks.
Eigen::MatrixXd Newton::solve_tissue(const Reduction& reduction,
                                     const Eigen::MatrixXd& forces) const {
  const auto terms = Eigen::Index(m_columns.size()), count = forces.cols();
  Eigen::MatrixXd y(forces.rows(), count + terms), rows(forces.rows(), terms);
  for (Eigen::Index k = 0; k < count; ++k) y.col(k) = reduction.restrict_force(forces.col(k));
  for (Eigen::Index k = 0; k < terms; ++k) {
    y.col(count + k) = reduction.restrict_force(m_columns[std::size_t(k)]);
    rows.col(k) = reduction.restrict_force(m_rows[std::size_t(k)]);
  }
  m_cache.solver->solve(y);
  if (terms > 0) {
    const Eigen::MatrixXd columns = y.rightCols(terms);
    const Eigen::MatrixXd small =
        Eigen::MatrixXd::Identity(terms, terms) + rows.transpose() * columns;
    y.leftCols(count) -= columns * small.partialPivLu().solve(rows.transpose() * y.leftCols(count));
  }
  Eigen::MatrixXd moved(forces.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) moved.col(k) = reduction.expand(y.col(k));
  return moved;
}

// The step of tissue and devices, and the multipliers of contact and coupling rows.
Newton::Step Newton::direction(const Reduction& reduction) {
  Stopwatch watch(m_report.seconds_factor);
  const Eigen::VectorXd& c = reduction.particular();
  Eigen::VectorXd product;
  m_cache.stiffness.multiply(c, product);
  Eigen::VectorXd rhs = m_load - product;
  for (std::size_t k = 0; k < m_columns.size(); ++k) rhs -= m_columns[k] * m_rows[k].dot(c);

  Step step;
  Eigen::VectorXd pushed = m_load;   // with what the coupling adds
  if (m_coupling.empty()) {
    step.dx = solve_tissue(reduction, rhs) + c;
  } else {
    couple(reduction, rhs, step, pushed);
  }
  m_cache.stiffness.multiply(step.dx, product);
  Eigen::VectorXd unbalanced = pushed - product;
  for (std::size_t k = 0; k < m_columns.size(); ++k) {
    unbalanced -= m_columns[k] * m_rows[k].dot(step.dx);
  }
  step.multipliers.assign(m_active.size() + 1, 0.0);   // the last one collects fixed rows
  reduction.multipliers(unbalanced, step.multipliers);
  step.multipliers.pop_back();
  step.slope = m_load.dot(step.dx);
  for (std::size_t d = 0; d < step.dq.size(); ++d) step.slope += m_device_load[d].dot(step.dq[d]);
  predict(step);
  return step;
}

bool Newton::update_active(const Step& step) {
  const ContactRows& contacts = m_eq.contacts();
  const double diameter = m_eq.mesh().diameter();
  const double slack = 1e-12 * diameter;
  // A floppy body would fly far past its obstacles: only those met early on the way are added.
  const double reach = std::min(1.0, reach_of_a_step * diameter / max_norm(step.dx));
  bool changed = false;
  for (std::size_t r = 0; r < contacts.size(); ++r) {
    if (m_active[r]) {
      if (step.multipliers[r] < 0.0) {
        m_active[r] = 0;
        changed = true;
      }
      continue;
    }
    const ContactRow& row = contacts.row(r);
    const GapSample& g = m_forces.gaps[r];
    if (mobility(r) == 0.0) continue;
    double change = g.normal.dot(step.dx.segment<3>(3 * row.node));
    if (row.partner >= 0) change -= g.normal.dot(step.dx.segment<3>(3 * row.partner));
    if (g.gap + reach * change < -slack) {
      m_active[r] = 1;
      changed = true;
    }
  }
  return changed;
}

bool Newton::find_step(Step& step, bool fresh) {
  if (!fresh) {   // the factor at hand, with rows and forces of today
    step = direction(make_reduction(&*m_factored));
    return step.dx.allFinite();
  }
  linearise();
  if (!factorise_devices()) return false;
  choose_active();
  for (int change = 0;;) {
    const Reduction reduction = make_reduction();
    reduction.reduce(m_cache.stiffness, m_cache.stiffness.mean_diagonal(), m_cache.reduced);
    if (!m_definite) {
      Stopwatch watch(m_report.seconds_factor);
      ++m_report.factorisations;
      if (!m_cache.solver->factorise(m_cache.reduced)) {
        ++m_report.shifted_factorisations;
        m_definite = true;   // for this iteration
        linearise();
        continue;
      }
    } else if (!factorise_shifted(reduction)) {
      return false;
    }
    step = direction(reduction);
    if (!step.dx.allFinite()) return false;
    const std::vector<char> used = m_active;
    m_factored = reduction;
    if (!update_active(step)) return true;
    if (++change >= max_active_set_changes) {
      m_active = used;
      return true;
    }
  }
}

bool Newton::no_new_inversion(const Points& u, const Eigen::VectorXd& before) const {
  const Eigen::VectorXd now = m_eq.tissue().jacobians(u);
  for (Eigen::Index t = 0; t < now.size(); ++t) {
    if (!(now[t] > 0.0) && before[t] > 0.0) return false;
  }
  return true;
}

// Moves nodes back onto the surfaces they have passed, and active ones to the gap the step gives
// them (what is left of theirs after `part` of the way), so that every iterate is feasible and the
// energy alone can judge a step.
void Newton::make_feasible(double part, Points& u, std::vector<char>& touched) const {
  const ContactRows& contacts = m_eq.contacts();
  const double slack = 1e-13 * m_eq.mesh().diameter();
  touched = m_active;
  for (int sweep = 0; sweep < 20; ++sweep) {
    double worst = 0.0;
    for (std::size_t r = 0; r < contacts.size(); ++r) {
      const GapSample g = contacts.sample(r, u);
      const ContactRow& row = contacts.row(r);
      const Vec3 push = free_part(row.node, g.normal);
      const Vec3 back = row.partner >= 0 ? free_part(row.partner, g.normal) : Vec3(Vec3::Zero());
      const double mobility = g.normal.dot(push + back);
      if (mobility <= 1e-12 * g.normal.squaredNorm()) continue;   // held on both sides
      if (g.gap < -slack) touched[r] = 1;
      const double target =
          m_active[r] ? (1.0 - part) * std::max(m_forces.gaps[r].gap, 0.0) : 0.0;
      const double over = g.gap - target;
      if (!touched[r] || std::abs(over) <= slack) continue;
      worst = std::max(worst, std::abs(over));
      m_eq.blocks().move(row.node, -over / mobility * push, u);
      if (row.partner >= 0) m_eq.blocks().move(row.partner, over / mobility * back, u);
    }
    if (worst == 0.0) break;
  }
}

// Backtracking on the change of energy (and of what open ties and slip add to the merit); returns the
// part of the step taken, 0 if none would do.
double Newton::search(const Step& step, MechanicalState& next) {
  Stopwatch watch(m_report.seconds_line_search);
  const Points& u0 = m_state.u;
  const Points external0 = m_forces.external;
  const double energy0 = m_eq.stored_energy(u0) + device_energy(m_state.devices);
  const double rows0 = merit_of_rows(m_state, step.weight);
  const Eigen::VectorXd jacobians = m_eq.tissue().jacobians(u0);
  std::vector<char> touched;
  double part = 1.0;
  for (int attempt = 0; attempt < 30; ++attempt) {
    next.u = u0;
    m_eq.blocks().scatter_add(step.dx, part, next.u);
    make_feasible(part, next.u, touched);
    move_devices(step, part, next);
    if (!next.u.allFinite() || !no_new_inversion(next.u, jacobians)) {
      part *= 0.5;
      continue;
    }
    const double energy1 = m_eq.stored_energy(next.u) + device_energy(next.devices);
    double work = m_eq.external_work(u0, external0, next.u) +
                  m_offset.tissue.dot(m_eq.blocks().gather_motion(next.u - u0));
    for (std::size_t d = 0; d < step.dq.size(); ++d) {
      work += part * m_offset.devices[d].dot(step.dq[d]);
    }
    const double change = energy1 - energy0 - work + merit_of_rows(next, step.weight) - rows0;
    // Rounding of energies, and of the gaps of ties that are as closed as they can be.
    const double noise = 1e-12 * (std::abs(energy0) + std::abs(energy1) + std::abs(work)) +
                         1e-13 * m_eq.mesh().diameter() * step.weight * double(m_couplings.size());
    if (change <= -1e-4 * part * step.predicted + noise) {
      m_active = touched;
      return part;
    }
    // Minimum of the parabola through value and slope at 0 and the value here, kept in [0.1, 0.5].
    const double bend = change + part * step.predicted;
    const double best = bend > 0.0 ? 0.5 * part * part * step.predicted / bend : 0.5 * part;
    part = std::clamp(best, 0.1 * part, 0.5 * part);
  }
  return 0.0;
}

// Multipliers that balance the forces at the present state best; negative ones are given up.
void Newton::estimate_multipliers() {
  std::vector<double> found(m_active.size() + 1, 0.0);
  make_reduction().multipliers(m_load + coupling_force(), found);
  found.pop_back();
  for (std::size_t r = 0; r < found.size(); ++r) {
    m_state.multipliers[r] = m_active[r] ? std::max(found[r], 0.0) : 0.0;
  }
}

void Newton::measure() {
  const Blocks& blocks = m_eq.blocks();
  const Eigen::VectorXd contact = m_eq.contact_force(m_forces, m_state.multipliers);
  const Eigen::VectorXd coupling = coupling_force();
  const Eigen::VectorXd total = m_load + contact + coupling;
  const Reduction fixed(blocks.count(), m_eq.fixed_rows());
  const Eigen::VectorXd rest = fixed.project(total);
  const double constraint =
      std::max({max_norm(contact), max_norm(coupling), max_norm(total - rest)});
  const double scale =
      std::max({max_norm(blocks.gather(m_forces.internal)),
                max_norm(blocks.gather(m_forces.external) + m_offset.tissue), constraint,
                m_eq.force_floor()});
  m_report.residual = std::max(max_norm(rest), device_residual()) / scale;
  measure_coupling();
  m_report.complementarity = 0.0;
  m_report.violation = 0.0;
  m_report.active_contacts = 0;
  for (std::size_t r = 0; r < m_forces.gaps.size(); ++r) {
    const double gap = m_forces.gaps[r].gap, multiplier = m_state.multipliers[r];
    if (mobility(r) == 0.0) continue;
    m_report.violation = std::max(m_report.violation, -gap);
    m_report.complementarity =
        std::max(m_report.complementarity,
                 std::abs(std::min(gap / m_eq.mesh().diameter(), multiplier / scale)));
    // Forces below the tolerance are rounding, not contact.
    if (multiplier > m_options.residual_tolerance * scale) ++m_report.active_contacts;
  }
}

bool Newton::small_enough(double last_correction) const {
  return m_report.residual <= m_options.residual_tolerance &&
         m_report.complementarity <= m_options.complementarity_tolerance &&
         m_report.tie_gap <= m_options.correction_tolerance * m_eq.mesh().diameter() &&
         last_correction <= m_options.correction_tolerance * m_eq.mesh().diameter();
}

Offset Newton::unbalanced(const MechanicalState& state) {
  m_state = state;
  m_offset = no_offset();
  refresh();
  Offset total{m_load + m_eq.contact_force(m_forces, m_state.multipliers) + coupling_force(),
               coupled_device_load()};
  return total;
}

void Newton::certify(const MechanicalState& state) {
  m_state = state;
  m_offset = no_offset();
  refresh();
  measure();
  m_report.energy = m_eq.stored_energy(state.u) + device_energy(state.devices);
  m_report.smallest_jacobian = m_eq.tissue().jacobians(state.u).minCoeff();
}

Newton::Outcome Newton::solve(MechanicalState& state, const Offset& offset, double load_factor) {
  m_state = state;
  m_offset = offset;
  m_definite = false;
  m_active.assign(m_eq.contacts().size(), 0);
  double last = std::numeric_limits<double>::infinity();
  double previous = last;
  bool fresh = true;
  std::vector<char> factored_set;
  refresh();
  measure();
  if (m_report.residual <= 1e-4 * m_options.residual_tolerance &&
      m_report.complementarity <= m_options.complementarity_tolerance &&
      m_report.tie_gap <= 1e-4 * m_options.correction_tolerance * m_eq.mesh().diameter()) {
    m_report.last_correction = 0.0;
    return Outcome::converged;
  }
  for (int iteration = 1; iteration <= m_options.max_iterations; ++iteration) {
    Step step;
    if (!find_step(step, fresh)) return Outcome::stuck;
    if (fresh) factored_set = m_active;
    MechanicalState next = m_state;
    const double part = search(step, next);
    if (part == 0.0) {
      if (!fresh) {   // the stale factor was to blame, perhaps
        fresh = true;
        m_active = factored_set;
        continue;
      }
      if (m_definite) return Outcome::stuck;
      m_definite = true;
      continue;
    }
    m_definite = false;
    previous = last;
    last = max_norm(step.dx) * part;
    for (const Eigen::VectorXd& dq : step.dq) {
      for (Eigen::Index i = 0; i < dq.size(); i += 6) {
        last = std::max(last, part * dq.segment<3>(i).cwiseAbs().maxCoeff());
      }
    }
    m_state.u = std::move(next.u);
    m_state.devices = std::move(next.devices);
    refresh();
    estimate_multipliers();
    measure();
    ++m_report.iterations;
    m_report.last_correction = last;
    if (m_options.progress &&
        !m_options.progress({load_factor, m_report.iterations, m_report.residual})) {
      return Outcome::cancelled;
    }
    if (small_enough(last)) {
      state = m_state;
      return Outcome::converged;
    }
    // The factor at hand serves again while the set stands and it converges fast.
    const bool same = m_active == factored_set;
    fresh = !(same && part == 1.0 && last <= 1e-3 * m_eq.mesh().diameter() &&
              last <= 0.1 * previous);
  }
  return Outcome::out_of_iterations;
}

}  // namespace brainshift
