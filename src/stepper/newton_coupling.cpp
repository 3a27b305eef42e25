// The part of Newton's method that knows devices: they are factored on their own and meet the tissue
// in the space of the coupling rows, as one mixed complementarity problem.
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "brainshift/error.hpp"
#include "brainshift/mcp.hpp"
#include "stepper/newton.hpp"

namespace brainshift {
namespace {

// Gaps are differences of positions: rounding of them, as part of the largest coordinate. Where rows
// all but depend on each other (a track along an edge of the mesh), that is not to be read as a
// contradiction between them.
constexpr double gap_rounding = 64.0 * std::numeric_limits<double>::epsilon();

// A row that gives way by less than this part of what a node of the tissue would: both its sides are
// held, and rounding of its gap would make forces without bound of it.
constexpr double immovable = 1e-10;

// Takes such rows out of W z + q, lower <= z <= upper: they carry nothing. C: columns are the gradients
// of the rows on tissue; stiffness: of one of its nodes (mN/mm).
void take_out_held_rows(const SparseColumns& C, double stiffness, Eigen::MatrixXd& W,
                        Eigen::VectorXd& q, Eigen::VectorXd& lower, Eigen::VectorXd& upper) {
  for (Eigen::Index r = 0; r < q.size(); ++r) {
    if (W(r, r) * stiffness > immovable * C.col(r).squaredNorm()) continue;
    W.row(r).setZero();
    W.col(r).setZero();
    q[r] = lower[r] = upper[r] = 0.0;
  }
}

// What a row leaves open: the distance of a tie, how far a stop has been passed; slip is free to be.
double open_gap(const CouplingRow& row, double gap) {
  return row.one_sided() ? std::max(0.0, -gap) : std::abs(gap);
}

}  // namespace

Offset operator*(double factor, const Offset& offset) {
  Offset result = offset;
  result.tissue *= factor;
  for (Eigen::VectorXd& v : result.devices) v *= factor;
  return result;
}

Offset Newton::no_offset() const {
  Offset none{Eigen::VectorXd::Zero(3 * m_eq.blocks().count()), {}};
  for (const InsertedDevice& d : m_coupling.devices()) {
    none.devices.push_back(Eigen::VectorXd::Zero(d.beam.dof_count()));
  }
  return none;
}

void Newton::refresh_devices() {
  m_device_load.clear();
  for (std::size_t d = 0; d < m_coupling.devices().size(); ++d) {
    const Beam& beam = m_coupling.devices()[d].beam;
    Eigen::VectorXd gradient;
    BlockTridiagonal unused(beam.node_count());
    beam.tangent(m_state.devices[d].beam, gradient, unused);
    m_device_load.push_back(m_offset.devices[d] - gradient);
    if (m_euler) m_euler->add_force(d, m_state.devices[d].beam, m_device_load.back());
    m_coupling.hold(d, m_state.devices[d].beam, m_device_load.back());
  }
  m_couplings = m_coupling.rows(m_state.u, m_state.devices);
}

// Tangents of the devices, with a proximal term: a wire that only its anchor holds may turn about it
// freely until the rows are counted in, and a device under thrust is stable only in its tissue. The
// term is below the stiffness of tissue, so that proximal_steps() are few, and not too far below the
// device's own, or rounding would drown what it divides.
bool Newton::factorise_devices() {
  m_device_factors.resize(m_coupling.devices().size());
  m_proximal = no_offset().devices;
  for (std::size_t d = 0; d < m_device_factors.size(); ++d) {
    const Beam& beam = m_coupling.devices()[d].beam;
    const double size = beam.device().length() / double(beam.element_count());
    double bending = 0.0;
    for (Index e = 0; e < beam.element_count(); ++e) {
      bending = std::max(bending, beam.device().section(e).bending_2);
    }
    double shift = std::min(3e-3 * m_cache.stiffness.mean_diagonal(),
                            6e-6 * bending / (size * size * size));
    for (int attempt = 0;; ++attempt) {
      Eigen::VectorXd gradient;
      BlockTridiagonal K(beam.node_count());
      beam.tangent(m_state.devices[d].beam, gradient, K);
      if (!m_definite) m_coupling.add_tangent(m_couplings, m_state.devices, d, K);
      for (Index i = 0; i < beam.node_count(); ++i) {
        m_proximal[d].segment<3>(6 * i).setConstant(shift);
        m_proximal[d].segment<3>(6 * i + 3).setConstant(shift * size * size);
        K.diagonal(i).diagonal() += m_proximal[d].segment<6>(6 * i);
      }
      if (m_euler) m_euler->add_tangent(d, K);
      m_coupling.hold(d, m_state.devices[d].beam, K);
      if (m_device_factors[d].factorise(K) && m_device_factors[d].positive()) break;
      if (attempt == 30) return false;
      shift *= 10.0;
    }
  }
  return true;
}

// The linearised problem of tissue, devices and rows, docs/theory.md (18). Behind the `count` rows stand
// two columns for each tie that turns (20): its turn and its slip, with forces that are eliminated.
struct Newton::Coupled {
  Eigen::Index count;                // of rows
  std::vector<TieTurn> turns;
  SparseColumns N;                   // directions, one per column, on the motion of the path
  SparseColumns C;                   // gradients on the tissue, one per column
  std::vector<Eigen::MatrixXd> D, Y; // per device: gradients, B^-1 D
  Eigen::MatrixXd W;                 // C^T A^-1 C + sum D^T Y
  Eigen::VectorXd q;                 // without the devices' own steps
  Eigen::VectorXd lower, upper;      // of the rows

  // Of the turns: forces = -given^-1 (q + W rows), the rows' problem without them, and back.
  Eigen::PartialPivLU<Eigen::MatrixXd> given;
  Eigen::MatrixXd rows_alone;        // W of the rows, the turns eliminated

  Eigen::Index extra() const { return 2 * Eigen::Index(turns.size()); }
  void eliminate_turns();
  void drop_turns();
  Eigen::VectorXd alone(const Eigen::VectorXd& all) const;
  Eigen::VectorXd with_turns(const Eigen::VectorXd& rows, const Eigen::VectorXd& all) const;
};

// The quadratic form 2 a b + k b^2 of a turn is U S U^T with S = (0 1; 1 k); its force z = -S U^T d obeys
// U^T d + S^-1 z = 0, S^-1 = (-k 1; 1 0).
void Newton::Coupled::eliminate_turns() {
  rows_alone = W.topLeftCorner(count, count);
  if (turns.empty()) return;
  Eigen::MatrixXd own = W.bottomRightCorner(extra(), extra());
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const auto a = 2 * Eigen::Index(i), b = a + 1;
    own(a, a) -= turns[i].curvature;
    own(a, b) += 1.0;
    own(b, a) += 1.0;
  }
  given.compute(own);
  rows_alone -= W.topRightCorner(count, extra()) * given.solve(W.bottomLeftCorner(extra(), count));
  // A row that pulls when it is pushed: the energy has no minimum there, and the step none to find.
  constexpr double least = 0.1;
  const bool sound = rows_alone.allFinite() &&
                     (rows_alone.diagonal().array() >= least * W.diagonal().head(count).array()).all();
  if (!sound) drop_turns();
}

// What is left is positive semidefinite and converges all the same, if only linearly.
void Newton::Coupled::drop_turns() {
  turns.clear();
  const auto cut = [this](Eigen::MatrixXd& columns) { columns = columns.leftCols(count).eval(); };
  N = SparseColumns(N.leftCols(count));
  C = SparseColumns(C.leftCols(count));
  for (Eigen::MatrixXd& part : D) cut(part);
  for (Eigen::MatrixXd& part : Y) cut(part);
  W = W.topLeftCorner(count, count).eval();
  q = q.head(count).eval();
  rows_alone = W;
}

// The right side of the rows without the turns, from that of all.
Eigen::VectorXd Newton::Coupled::alone(const Eigen::VectorXd& all) const {
  if (turns.empty()) return all;
  return all.head(count) - W.topRightCorner(count, extra()) * given.solve(all.tail(extra()));
}

// Multipliers of the rows, and behind them the forces of the turns.
Eigen::VectorXd Newton::Coupled::with_turns(const Eigen::VectorXd& rows,
                                            const Eigen::VectorXd& all) const {
  if (turns.empty()) return rows;
  Eigen::VectorXd z(count + extra());
  z << rows, -given.solve(all.tail(extra()) + W.bottomLeftCorner(extra(), count) * rows);
  return z;
}

void Newton::add_devices(Coupled& problem) const {
  for (std::size_t d = 0; d < m_device_load.size(); ++d) {
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(m_device_load[d].size(), problem.q.size());
    for (Eigen::Index r = 0; r < problem.count; ++r) {
      const CouplingRow& row = m_couplings[std::size_t(r)];
      if (row.device == d) D.col(r) = m_coupling.device_gradient(row, m_state.devices);
    }
    for (std::size_t i = 0; i < problem.turns.size(); ++i) {
      const TieTurn& turn = problem.turns[i];
      if (turn.slip.device != d) continue;
      const Eigen::Index a = problem.count + 2 * Eigen::Index(i);
      D.col(a) = turn.turn;
      D.col(a + 1) = m_coupling.device_gradient(turn.slip, m_state.devices);
    }
    Eigen::MatrixXd Y = D;
    m_device_factors[d].solve(Y);
    problem.W += D.transpose() * Y;
    problem.D.push_back(std::move(D));
    problem.Y.push_back(std::move(Y));
  }
}

// Multipliers, and the steps of the devices under `loads`; false: there are none.
bool Newton::solve_rows(const Coupled& problem, const DeviceVectors& loads, Step& step) {
  step.dq = loads;
  Eigen::VectorXd q = problem.q;
  for (std::size_t d = 0; d < loads.size(); ++d) {
    m_device_factors[d].solve(step.dq[d]);
    q += problem.D[d].transpose() * step.dq[d];
  }
  step.coupling.resize(problem.count);
  step.pushed = Eigen::VectorXd::Zero(q.size());
  if (problem.count == 0) return true;
  Eigen::MatrixXd W = problem.rows_alone;
  Eigen::VectorXd right = problem.alone(q), lower = problem.lower, upper = problem.upper;
  take_out_held_rows(problem.C, m_cache.stiffness.mean_diagonal(), W, right, lower, upper);
  McpOptions options;
  options.noise = gap_rounding * m_eq.mesh().nodes().cwiseAbs().maxCoeff();
  const McpSolution found = solve_mcp(W, right, lower, upper, options);
  m_report.coupling_rank = found.report.rank;
  m_report.coupling_unique = found.report.unique;
  if (found.report.status != McpStatus::solved) return false;
  step.coupling = found.z;
  step.pushed = problem.with_turns(found.z, q);
  for (std::size_t d = 0; d < loads.size(); ++d) step.dq[d] += problem.Y[d] * step.pushed;
  return step.pushed.allFinite();
}

// Takes the proximal term P out of the step again: (B + P) dq' = load + P dq + D multiplier, from dq
// to dq', until they are the same (Rockafellar 1976). It contracts where the tangents are positive on
// the motions the rows leave; where it does not, the step with the term stands. Nothing here touches
// the tissue, so that all of it costs less than one iteration of Newton's method.
void Newton::proximal_steps(const Coupled& problem, Step& step) {
  constexpr int most = 200;
  constexpr double enough = 1e-7;  // of the first change
  const Step first = step;
  double before = std::numeric_limits<double>::infinity(), start = 0.0;
  for (int i = 0; i < most; ++i) {
    DeviceVectors loads = m_device_load;
    for (std::size_t d = 0; d < loads.size(); ++d) loads[d] += m_proximal[d].cwiseProduct(step.dq[d]);
    Step next = step;
    double change = 0.0;
    const bool solved = solve_rows(problem, loads, next);
    for (std::size_t d = 0; d < loads.size(); ++d) {
      const Eigen::VectorXd by = next.dq[d] - step.dq[d];
      change += by.dot(m_proximal[d].cwiseProduct(by));
    }
    if (i == 0) start = change;
    if (!solved || !(change <= before)) {
      if (change > enough * enough * start) step = first;
      return;
    }
    step = std::move(next);
    if (change <= enough * enough * start) return;
    before = change;
  }
}

// Rows and turns at the iterate, with the compliance the factor at hand gives them.
Newton::Coupled Newton::coupled_problem() const {
  Coupled problem;
  const auto count = problem.count = Eigen::Index(m_couplings.size());
  if (!m_definite) problem.turns = m_coupling.turns(m_couplings, m_state.devices);
  const auto all = count + problem.extra();
  problem.q = Eigen::VectorXd::Zero(all);
  problem.lower.resize(count);
  problem.upper.resize(count);
  std::vector<Eigen::Triplet<double>> directions;   // of the columns, on those of their path points
  const auto add = [&](const CouplingRow& row, Eigen::Index column) {
    if (!m_coupling.is_on_tissue(row)) return;
    for (int k = 0; k < 3; ++k) {
      directions.emplace_back(int(m_coupling.path_column(row)) + k, int(column), row.direction[k]);
    }
  };
  for (Eigen::Index r = 0; r < count; ++r) {
    const CouplingRow& row = m_couplings[std::size_t(r)];
    problem.q[r] = row.gap - row.give * multiplier_of(m_state.devices[row.device], row);
    problem.lower[r] = row.lower;
    problem.upper[r] = row.upper;
    add(row, r);
  }
  // The turn of a device does not touch the tissue: its column stays empty.
  for (std::size_t i = 0; i < problem.turns.size(); ++i) {
    add(problem.turns[i].slip, count + 2 * Eigen::Index(i) + 1);
  }
  SparseColumns& N = problem.N;
  N.resize(m_linearised->path().cols(), all);
  N.setFromTriplets(directions.begin(), directions.end());
  problem.C = m_linearised->path() * N;
  problem.W = N.transpose() * Eigen::MatrixXd(m_linearised->compliance() * N);
  for (Eigen::Index r = 0; r < count; ++r) problem.W(r, r) += m_couplings[std::size_t(r)].give;
  add_devices(problem);
  problem.eliminate_turns();
  return problem;
}

// W multiplier + (gap + rows . free step) = w,  W = C A^-1 C^T + D B^-1 D^T.
void Newton::couple(Step& step, Eigen::VectorXd& pushed) {
  Coupled problem = coupled_problem();
  problem.q += problem.N.transpose() * m_linearised->free_motion();
  if (!solve_rows(problem, m_device_load, step)) {
    step.dx.setConstant(m_load.size(), std::nan(""));
    step.coupling.setConstant(std::nan(""));
    return;
  }
  if (!m_definite) proximal_steps(problem, step);
  step.dx = m_linearised->step(problem.N * step.pushed);
  pushed += problem.C * step.pushed;
}

// First-order fall of the merit E + sum bound |slip| + weight * sum |open tie| + sum give/2 multiplier^2.
void Newton::predict(Step& step) const {
  step.predicted = step.slope;
  for (Eigen::Index r = 0; r < step.coupling.size(); ++r) {
    const CouplingRow& row = m_couplings[std::size_t(r)];
    if (row.kind == RowKind::along) continue;
    step.weight = std::max(step.weight, 2.0 * std::abs(step.coupling[r]));
  }
  const Eigen::VectorXd motion = m_linearised->path().transpose() * step.dx;
  for (Eigen::Index r = 0; r < step.coupling.size(); ++r) {
    const CouplingRow& row = m_couplings[std::size_t(r)];
    if (row.kind != RowKind::along) {
      const double multiplier = multiplier_of(m_state.devices[row.device], row);
      step.predicted += step.weight * open_gap(row, row.gap) -
                        row.give * multiplier * (step.coupling[r] - multiplier);
      continue;
    }
    double change =
        row.direction.dot(motion.segment<3>(m_coupling.path_column(row))) +
        m_coupling.device_gradient(row, m_state.devices).dot(step.dq[row.device]);
    step.predicted -= row.upper * (std::abs(row.gap + change) - std::abs(row.gap));
  }
}

double Newton::merit_of_rows(const MechanicalState& state, double weight) const {
  if (m_coupling.empty()) return 0.0;
  double sum = 0.0;
  for (const CouplingRow& row : m_coupling.rows(state.u, state.devices)) {
    const double multiplier = multiplier_of(state.devices[row.device], row);
    sum += (row.kind == RowKind::along ? row.upper : weight) * open_gap(row, row.gap) +
           0.5 * row.give * multiplier * multiplier;
  }
  return sum;
}

double Newton::device_energy(const std::vector<DeviceMotion>& motions) const {
  double sum = 0.0;
  for (std::size_t d = 0; d < motions.size(); ++d) {
    sum += m_coupling.devices()[d].beam.energy(motions[d].beam);
  }
  return sum;
}

void Newton::move_devices(const Step& step, double part, MechanicalState& next) const {
  next.devices = m_state.devices;
  for (std::size_t d = 0; d < step.dq.size(); ++d) {
    m_coupling.devices()[d].beam.update(next.devices[d].beam, part * step.dq[d]);
  }
  for (Eigen::Index r = 0; r < step.coupling.size(); ++r) {
    const CouplingRow& row = m_couplings[std::size_t(r)];
    double& multiplier = multiplier_of(next.devices[row.device], row);
    multiplier += part * (step.coupling[r] - multiplier);
  }
}

Eigen::VectorXd Newton::coupling_force() const {
  Points nodal = Points::Zero(m_eq.mesh().node_count(), 3);
  DeviceVectors unused = no_offset().devices;
  m_coupling.add_forces(m_couplings, m_state.devices, nodal, unused);
  return m_eq.blocks().gather(nodal);
}

DeviceVectors Newton::coupled_device_load() const {
  Points unused = Points::Zero(m_eq.mesh().node_count(), 3);
  DeviceVectors load = m_device_load;
  m_coupling.add_forces(m_couplings, m_state.devices, unused, load);
  return load;
}

// Largest force out of balance on a device, beyond what the rounding of positions makes of its axial
// stiffness; moments count as forces on an arm of one element.
double Newton::device_residual() const {
  double largest = 0.0;
  const DeviceVectors load = coupled_device_load();
  for (std::size_t d = 0; d < load.size(); ++d) {
    const Beam& beam = m_coupling.devices()[d].beam;
    const double arm = beam.device().length() / double(beam.element_count());
    double stiffest = 0.0, worst = 0.0;
    for (Index e = 0; e < beam.element_count(); ++e) {
      stiffest = std::max(stiffest, beam.device().section(e).axial / arm);
    }
    for (Index i = 0; i < beam.node_count(); ++i) {
      worst = std::max(worst, load[d].segment<3>(6 * i).cwiseAbs().maxCoeff());
      worst = std::max(worst, load[d].segment<3>(6 * i + 3).cwiseAbs().maxCoeff() / arm);
    }
    const double size = m_state.devices[d].beam.x.cwiseAbs().maxCoeff();
    const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * size * stiffest;
    largest = std::max(largest, worst - rounding);
  }
  return largest;
}

// Open ties and stops, and how far multipliers are from their boxes. Of friction at its bound the slip
// must go against the force: gap grows with the multiplier's push, so both have opposite signs.
void Newton::measure_coupling(double force_scale) {
  m_report.tie_gap = 0.0;
  m_report.coupling_rows = Index(m_couplings.size());
  const double diameter = m_eq.mesh().diameter();
  for (const CouplingRow& row : m_couplings) {
    const double multiplier = multiplier_of(m_state.devices[row.device], row);
    const double beyond = std::max({0.0, row.lower - multiplier, multiplier - row.upper});
    double wrong = beyond / force_scale;
    double open = open_gap(row, row.gap);
    if (row.one_sided()) {
      wrong = std::max(wrong, std::abs(std::min(row.gap / diameter, multiplier / force_scale)));
    } else if (row.kind == RowKind::along) {
      const double left = row.upper - std::abs(multiplier);   // of the bound
      const bool against = row.gap * multiplier <= 0.0;
      // Sticking: no slip; at the bound: slip against the force.
      open = against ? std::min(open, std::max(left, 0.0) * diameter / force_scale) : open;
    }
    m_report.complementarity = std::max(m_report.complementarity, wrong);
    m_report.tie_gap = std::max(m_report.tie_gap, open);
  }
}

}  // namespace brainshift
