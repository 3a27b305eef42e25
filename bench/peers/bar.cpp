// A clamped bar of Saint-Venant-Kirchhoff tissue under its weight, for comparison with other programs:
// 200 x 40 x 40 mm in 5n x n x n cells of six tets, x = 0 held, E 6 kPa, nu 0.45, dead load.
//
//   bench_bar mesh N GRAVITY PREFIX                       writes PREFIX.mesh: nodes and tets
//   bench_bar solve N GRAVITY INCREMENTS ACCURACY PREFIX  writes PREFIX.u: displacements, mm
//
// GRAVITY in parts of the earth's; ACCURACY (mm) as of within(). Both print JSON. Seconds are CPU seconds of
// one thread, so that they bear a busy machine.
#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "brainshift/brainshift.hpp"
#include "clock.hpp"
#include "linear/spd_solver.hpp"
#include "stiffness_at_rest.hpp"
#include "support/scenes.hpp"

namespace {

using namespace brainshift;
using bench::Clock;

using Words = std::vector<std::string>;

constexpr double young = 6.0, poisson = 0.45;   // kPa, 1

Vec3 weight(double gravity) { return {0.0, 0.0, -gravity * standard_gravity}; }

Scene make_bar(Index n, double gravity) {
  Scene scene{test::make_mesh(test::make_box({200.0, 40.0, 40.0}, 5 * n, n, n)),
              {{0, Material(Law::st_venant_kirchhoff, young, poisson, test::tissue_density)}}};
  scene.gravity = weight(gravity);
  scene.balanced_reference = false;
  scene.constraints.fix("wall", test::nodes_where(scene.mesh, [](const Vec3& x) { return x.x() == 0.0; }));
  return scene;
}

template <class Rows>
void write_rows(std::ofstream& file, const Rows& rows) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    for (Eigen::Index k = 0; k < rows.cols(); ++k) file << (k ? " " : "") << rows(i, k);
    file << "\n";
  }
}

std::ofstream open(const std::string& path) {
  std::ofstream file(path);
  file << std::setprecision(17);
  return file;
}

void check(const std::ofstream& file, const std::string& path) {
  if (!file) throw Error(ErrorCode::file, "cannot write " + path + "; is its folder there?");
}

// One numeric factor and one solve of the bar's stiffness at rest.
double bare_factor_and_solve(const Scene& scene) {
  const BlockMatrix A = bench::stiffness_at_rest(scene);
  const auto solver = make_spd_solver();
  solver->analyse(A);
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(3 * Eigen::Index(A.blocks()), 1);
  const Clock clock;
  solver->factorise(A);
  solver->solve(x);
  return clock.cpu();
}

nlohmann::json write_mesh(const Words& words) {
  const Scene scene = make_bar(std::stoi(words[0]), std::stod(words[1]));
  const std::string path = words[2] + ".mesh";
  std::ofstream file = open(path);
  file << scene.mesh.node_count() << " " << scene.mesh.tet_count() << "\n";
  write_rows(file, scene.mesh.nodes());
  write_rows(file, scene.mesh.tets());
  check(file, path);
  return {{"young", young}, {"poisson", poisson}, {"density", test::tissue_density}, {"gravity", -scene.gravity.z()}};
}

// The load in equal increments. What a solve counts is from its begin to its end, analysis and all.
nlohmann::json solve_in(int increments, double gravity, Stepper& stepper) {
  int iterations = 0, factorisations = 0;
  double seconds = 0.0, smallest = 1.0;
  for (int i = 1; i <= increments; ++i) {
    const Clock clock;
    stepper.set_gravity(weight(gravity * i / increments));
    const SolveReport report = stepper.solve_static();
    if (!report.converged()) throw Error(ErrorCode::internal, report.message);
    seconds += clock.cpu();
    iterations += report.iterations;
    factorisations += report.factorisations;
    smallest = report.smallest_jacobian;
  }
  return {{"seconds", seconds}, {"iterations", iterations}, {"factorisations", factorisations},
          {"smallest_jacobian", smallest}};
}

nlohmann::json solve(const Words& words) {
  const Index n = std::stoi(words[0]);
  const double gravity = std::stod(words[1]);
  const Scene scene = make_bar(n, gravity);
  Stepper stepper(scene, within(std::stod(words[3]), scene.mesh));
  nlohmann::json result = solve_in(std::stoi(words[2]), gravity, stepper);
  const std::string path = words[4] + ".u";
  std::ofstream file = open(path);
  write_rows(file, stepper.displacement());
  check(file, path);
  result["nodes"] = stepper.mesh().node_count();
  result["tets"] = stepper.mesh().tet_count();
  result["factor_and_solve_seconds"] = bare_factor_and_solve(scene);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const Words words(argv + std::min(argc, 2), argv + argc);
  const std::string what = argc > 1 ? argv[1] : "";
  try {
    if (what == "mesh" && words.size() == 3) {
      std::cout << write_mesh(words) << "\n";
    } else if (what == "solve" && words.size() == 5) {
      std::cout << solve(words) << "\n";
    } else {
      std::cerr << "bench_bar: mesh N GRAVITY PREFIX, or solve N GRAVITY INCREMENTS ACCURACY PREFIX\n";
      return 2;
    }
  } catch (const std::exception& e) {
    std::cerr << "bench_bar: " << e.what() << "\n";
    return 1;
  }
  return 0;
}
