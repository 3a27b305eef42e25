// How wrong a head's mesh makes the shift of its landmarks: linear, nodal and quadratic tets on a mesh and
// on its refinement, at equal volume of air, and the error estimate beside them.
//
// Run: build/release/bench/bench_head_accuracy HEAD [FINEST] > table.csv
//   FINEST: most unknowns of a solve (default 250000)
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "refined_head.hpp"
#include "scene.hpp"

namespace {

using namespace dbs;

const std::vector<std::string> names{"STN_right", "AC", "PC", "MCP", "frontal_pole_left"};

struct Result {
  std::string element;
  int refinements = 0;
  Points shift;  // of the landmarks, mm
  bool converged = false;
  double seconds = 0.0;
  Index nodes = 0;
  int iterations = 0;
  std::optional<ErrorEstimate> estimate;
};

Points landmark_points(const Head& head) {
  Points points(Eigen::Index(names.size()), 3);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Vec3 p = head.landmarks.at(names[i]);
    points.row(Eigen::Index(i)) = p.transpose();
    if (head.brain.locate(points.row(Eigen::Index(i))).tet[0] >= 0) continue;
    Eigen::Index nearest;  // else the tissue closest to it
    (head.brain.nodes().rowwise() - p.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    points.row(Eigen::Index(i)) = head.brain.nodes().row(nearest);
  }
  return points;
}

Result lose_fluid(const Head& head, const Points& points, const std::string& element,
                  int refinements, double air_mL, double poisson) {
  Options options;
  options.element = element;
  options.poisson = poisson;
  SceneIds ids;
  Scene scene = make_scene(head, options, ids);
  let_touch(scene, ids.skull);
  Stepper stepper(scene);
  for (int side : {left, right}) {
    stepper.csf().set_air_volume(stepper.csf().find(name_of(side)), air_mL * mm3_per_ml);
  }
  const SolveReport report = stepper.solve_static();
  Result r;
  r.element = element;
  r.refinements = refinements;
  r.converged = report.converged();
  r.seconds = report.seconds;
  r.iterations = report.iterations;
  r.nodes = stepper.mesh().node_count();
  r.shift = stepper.displacement_at(points).values;
  if (r.converged && element != "quadratic") r.estimate = stepper.estimate_error(points);
  std::fprintf(stderr, "%s, refined %d times: %d nodes, %d iterations, %.1f s%s\n", element.c_str(),
               refinements, r.nodes, r.iterations, r.seconds, r.converged ? "" : ", not converged");
  return r;
}

void print(const Result& r, const Points& reference, double poisson) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto row = Eigen::Index(i);
    std::printf("%g,%s,%d,%d,%d,%.2f,%s,%.6f,%.6f,%.6f,%.6f,", poisson, r.element.c_str(),
                r.refinements, r.nodes, r.iterations, r.seconds, names[i].c_str(), r.shift(row, 0),
                r.shift(row, 1), r.shift(row, 2), (r.shift.row(row) - reference.row(row)).norm());
    if (r.estimate) std::printf("%.6f", r.estimate->error[row]);
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    std::fprintf(stderr, "bench_head_accuracy: give the folder of a head\n");
    return 1;
  }
  const double finest = argc > 2 ? std::atof(argv[2]) : 250000.0;
  const Head head = read_head(argv[1]), fine = refined(head);
  const Points points = landmark_points(head);
  constexpr double air = 11.0;  // mL on each side
  std::printf("poisson,element,refined,nodes,iterations,seconds,landmark,x,y,z,error,estimate\n");
  for (double poisson : {0.45}) {
    std::vector<Result> results;
    for (const char* element : {"linear", "nodal", "quadratic"}) {
      results.push_back(lose_fluid(head, points, element, 0, air, poisson));
    }
    for (const char* element : {"linear", "nodal", "quadratic"}) {
      // Unknowns that cost as much: quadratic tets have more nodes, nodal volumes wider rows.
      const double wide = element == std::string("linear") ? 1.0 : element[0] == 'n' ? 2.0 : 8.0;
      if (3.0 * wide * fine.brain.node_count() > finest) continue;
      results.push_back(lose_fluid(fine, points, element, 1, air, poisson));
    }
    // Linear tets to order two; the reference is the finest quadratic solution.
    Points reference = results[2].shift;
    for (const Result& r : results) {
      if (!r.converged) std::fprintf(stderr, "%s did not converge\n", r.element.c_str());
      if (r.element == "quadratic") reference = r.shift;
    }
    for (const Result& r : results) print(r, reference, poisson);
    if (results.size() > 3) {
      Result extrapolated;
      extrapolated.element = "linear extrapolated";
      extrapolated.refinements = 1;
      extrapolated.shift = (4.0 * results[3].shift - results[0].shift) / 3.0;
      print(extrapolated, reference, poisson);
    }
  }
  return 0;
} catch (const brainshift::Error& error) {
  std::fprintf(stderr, "bench_head_accuracy: %s\n", error.what());
  return 1;
}
