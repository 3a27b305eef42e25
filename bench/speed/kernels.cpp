// What the parts of a Newton iteration on a head cost. `yardstick` is one numeric factor and one solve of
// the stiffness of both halves as one system: bench/speed/report.py gives every other time in it.
#include <cmath>
#include <memory>
#include <random>

#include <benchmark/benchmark.h>

#include "beam/beam.hpp"
#include "brainshift/mcp.hpp"
#include "speed/heads.hpp"
#include "speed/rest.hpp"

namespace {

using namespace dbs;
using bench::Rest;

const Rest& rest() {
  static const Rest at_rest(bench::head());
  return at_rest;
}

void element_forces(benchmark::State& state, const char* law) {
  Options options;
  options.law = law;
  SceneIds ids;
  const Equilibrium balance(make_scene(bench::head(), options, ids));
  const Points& u = rest().u;
  for (auto _ : state) benchmark::DoNotOptimize(balance.tissue().response(u));
  state.counters["tets"] = double(bench::head().brain.tet_count());
}

void tangent(benchmark::State& state, const char* law) {
  Options options;
  options.law = law;
  SceneIds ids;
  const Equilibrium balance(make_scene(bench::head(), options, ids));
  const Forces forces = balance.forces(rest().u);
  BlockMatrix K = balance.blocks().make_matrix();
  for (auto _ : state) balance.tangent(rest().u, forces, rest().multipliers, false, K);
}

void waterline(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(rest().balance.external_force(rest().u));
}

void contact_gaps(benchmark::State& state) {
  std::vector<GapSample> gaps;
  for (auto _ : state) rest().balance.contacts().sample(rest().u, gaps);
  state.counters["rows"] = double(rest().balance.contacts().size());
}

void reduction(benchmark::State& state) {
  BlockMatrix A = rest().balance.blocks().make_matrix();
  for (auto _ : state) {
    const Reduction fixed(rest().balance.blocks().count(), rest().balance.fixed_rows());
    fixed.reduce(rest().tangent, 1.0, A);
  }
}

void product(benchmark::State& state) {
  const Eigen::VectorXd x = Eigen::VectorXd::Ones(rest().unknowns());
  Eigen::VectorXd y;
  for (auto _ : state) rest().tangent.multiply(x, y);
}

// Order and pattern of the matrix, made once for a mesh and its constraints.
void ordering(benchmark::State& state) {
  const Equilibrium& balance = rest().balance;
  const std::vector<Indices> near = balance.tissue().node_adjacency();
  const ConstraintSet none;
  for (auto _ : state) benchmark::DoNotOptimize(Blocks(balance.mesh(), near, none).count());
}

// Where the blocks of each tet go, made once for a pattern.
void element_map(benchmark::State& state) {
  const Equilibrium& balance = rest().balance;
  const BlockMatrix K = balance.blocks().make_matrix();
  for (auto _ : state) {
    benchmark::DoNotOptimize(balance.tissue().map_elements(balance.blocks().block_of(), K).slots.size());
  }
}

void analysis(benchmark::State& state) {
  const auto solver = make_spd_solver();
  for (auto _ : state) solver->analyse(rest().tangent);
}

void factor(benchmark::State& state) {
  for (auto _ : state) rest().solver->factorise(rest().tangent);
}

// With the factor in single precision, of a solver of its own.
void solve_rounded(benchmark::State& state) {
  const auto solver = make_spd_solver();
  solver->analyse(rest().tangent);
  solver->factorise(rest().tangent);
  if (!solver->round_factor()) state.SkipWithError("the factor cannot be rounded");
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(rest().unknowns(), 1);
  for (auto _ : state) solver->solve(x);
}

void solve(benchmark::State& state) {
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(rest().unknowns(), state.range(0));
  for (auto _ : state) rest().solver->solve(x);
}

// Points along the planned track, `rows` motions in all: of one lead 100, of two 200.
void compliance(benchmark::State& state) {
  const Mesh& mesh = bench::head().brain;
  const Plan& plan = bench::head().plans.at(right);
  const auto count = Eigen::Index(state.range(0));
  Points line((count + 2) / 3, 3);
  for (Eigen::Index i = 0; i < line.rows(); ++i) {
    line.row(i) = (plan.target + 45.0 * double(i) / double(line.rows()) * plan.outward).transpose();
  }
  const Location at = mesh.locate(line);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index c = 0; c < count; ++c) {
    const Index tet = at.tet[std::size_t(c / 3)];
    if (tet < 0) continue;
    const Interpolation in = mesh.interpolation(tet, at.weights.row(c / 3).transpose());
    for (std::size_t a = 0; a < std::size_t(in.count); ++a) {
      const Index block = rest().balance.blocks().block_of()[std::size_t(in.nodes[a])];
      entries.emplace_back(int(3 * block + c % 3), int(c), in.weights[a]);
    }
  }
  SparseColumns C(rest().unknowns(), count);
  C.setFromTriplets(entries.begin(), entries.end());
  for (auto _ : state) {
    rest().solver->keep(0);
    rest().solver->append(C);
  }
}

// Half of the rows bilateral, half one-sided, as dense as those of leads.
void complementarity(benchmark::State& state, McpMethod method) {
  const auto n = Eigen::Index(state.range(0));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(n, n, draw);
  const Eigen::MatrixXd M = half * half.transpose() / double(n) + 0.1 * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd q = Eigen::VectorXd::NullaryExpr(n, draw);
  const double inf = std::numeric_limits<double>::infinity();
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(n, -inf), upper = Eigen::VectorXd::Constant(n, inf);
  for (Eigen::Index i = 0; i < n; i += 2) lower[i] = 0.0;
  McpOptions options;
  options.method = method;
  for (auto _ : state) {
    const McpSolution solution = solve_mcp(M, q, lower, upper, options);
    if (solution.report.status != McpStatus::solved) state.SkipWithError("not solved");
  }
}

// The rows that tie a lead to tissue every so often, on one side: what it gives way by, held at its wire, and
// what the tissue does. The lead's part makes a far push at the wire felt at the tip, and sweeps crawl. To a
// tolerance of ten to the minus second argument; what they leave open is shown.
void complementarity_of_a_lead(benchmark::State& state, McpMethod method) {
  constexpr double length = 80.0, bending = 5000.0, tissue = 0.02, reach = 10.0;   // mm, mN mm^2, mm/mN, mm
  const auto n = Eigen::Index(state.range(0));
  Eigen::MatrixXd M(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double x = length * double(i + 1) / double(n), y = length * double(j + 1) / double(n);
      const double near = std::min(x, y), far = std::max(x, y);   // from the wire: a cantilever
      M(i, j) = near * near * (3.0 * far - near) / (6.0 * bending) + tissue * std::exp(-(far - near) / reach);
    }
  }
  const Eigen::VectorXd q = Eigen::VectorXd::NullaryExpr(n, [n](Eigen::Index i) {
    return std::sin(6.0 * double(i) / double(n)) - 0.3;   // mm, gaps
  });
  const double inf = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(n), upper = Eigen::VectorXd::Constant(n, inf);
  McpOptions options;
  options.method = method;
  options.tolerance = std::pow(10.0, -double(state.range(1)));
  McpReport report;
  for (auto _ : state) report = solve_mcp(M, q, lower, upper, options).report;
  state.counters["iterations_of_method"] = report.iterations;
  state.counters["left_open"] = report.residual;
}

// Tangent, factor and one solve of a lead bent a little.
void beam(benchmark::State& state) {
  const BeamDevice lead = BeamDevice::straight("lead", 300.0, Index(state.range(0)),
                                               rod_section(1.27, 5000.0, 0.4));
  const Beam model(lead, Vec3::Zero(), Mat3::Identity());
  BeamState bent = model.rest();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(model.dof_count()), gradient;
  for (Index i = 0; i < model.node_count(); ++i) step[6 * i + 1] = 1e-5 * std::pow(bent.x(i, 0), 2);
  model.update(bent, step);
  BlockTridiagonal K(model.node_count());
  BlockTridiagonalFactor factor;
  for (auto _ : state) {
    model.tangent(bent, gradient, K);
    for (Index dof = 0; dof < 6; ++dof) K.fix(dof);
    factor.factorise(K);
    Eigen::MatrixXd x = gradient;
    factor.solve(x);
    benchmark::DoNotOptimize(x);
  }
}

}  // namespace

void bench::yardstick(benchmark::State& state) {
  const Rest& r = rest();
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(r.unknowns(), 1);
  for (auto _ : state) {
    r.solver->factorise(r.tangent);
    r.solver->solve(x);
    x.setOnes();
  }
  state.counters["unknowns"] = double(r.unknowns());
  state.counters["factor_nonzeros"] = r.solver->factor_nonzeros();
}

BENCHMARK(bench::yardstick)->Name("yardstick")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(element_forces, corotational, "corotational")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(element_forces, st_venant_kirchhoff, "st_venant_kirchhoff")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(element_forces, stable_neo_hookean, "stable_neo_hookean")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tangent, corotational, "corotational")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tangent, stable_neo_hookean, "stable_neo_hookean")->Unit(benchmark::kMillisecond);
BENCHMARK(waterline)->Unit(benchmark::kMillisecond);
BENCHMARK(contact_gaps)->Unit(benchmark::kMillisecond);
BENCHMARK(reduction)->Unit(benchmark::kMillisecond);
BENCHMARK(product)->Unit(benchmark::kMillisecond);
BENCHMARK(ordering)->Unit(benchmark::kMillisecond);
BENCHMARK(element_map)->Unit(benchmark::kMillisecond);
BENCHMARK(analysis)->Unit(benchmark::kMillisecond);
BENCHMARK(factor)->Unit(benchmark::kMillisecond);
BENCHMARK(solve_rounded)->Unit(benchmark::kMillisecond);
BENCHMARK(solve)->Arg(1)->Arg(16)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(compliance)->Arg(10)->Arg(30)->Arg(100)->Arg(300)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(complementarity, newton, brainshift::McpMethod::newton)
    ->Arg(30)->Arg(100)->Arg(300)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(complementarity, gauss_seidel, brainshift::McpMethod::gauss_seidel)
    ->Arg(30)->Arg(100)->Arg(300)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(complementarity_of_a_lead, newton, brainshift::McpMethod::newton)
    ->ArgsProduct({{30, 100}, {3, 6, 10}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(complementarity_of_a_lead, pivoting, brainshift::McpMethod::pivoting)
    ->ArgsProduct({{30, 100}, {10}})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(complementarity_of_a_lead, gauss_seidel, brainshift::McpMethod::gauss_seidel)
    ->ArgsProduct({{30, 100}, {3, 6, 10}})->Unit(benchmark::kMillisecond);
BENCHMARK(beam)->Arg(40)->Arg(400)->Unit(benchmark::kMillisecond);
