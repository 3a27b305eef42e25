// hello.c in C++: a block of soft tissue stands on the floor of a box full of cerebrospinal fluid.
// The fluid is let out, buoyancy is gone, and the block sags. Prints the same numbers.
//
// Build: c++ -std=c++17 -I/usr/include/eigen3 hello.cpp -lbrainshift -lcholmod -lmetis -o hello
#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

#include "brainshift/brainshift.hpp"

using namespace brainshift;

namespace {

constexpr int cells = 6, side = cells + 1;
constexpr double edge = 60.0;  // mm

// Six tets per cell: one for each order in which x, y, z are climbed from corner to corner.
Mesh make_block() {
  const std::array<Index, 3> stride{1, side, side * side};
  Points nodes(side * side * side, 3);
  for (Index i = 0; i < nodes.rows(); ++i)
    for (int a = 0; a < 3; ++a) nodes(i, a) = edge / cells * (i / stride[std::size_t(a)] % side);
  Tets tets(6 * cells * cells * cells, 4);
  Index row = 0;
  for (Index c = 0; c < cells * cells * cells; ++c) {
    std::array<std::size_t, 3> climb{0, 1, 2};
    do {
      tets(row, 0) = c % cells + side * (c / cells % cells) + side * side * (c / cells / cells);
      for (int step = 0; step < 3; ++step)
        tets(row, step + 1) = tets(row, step) + stride[climb[std::size_t(step)]];
      ++row;
    } while (std::next_permutation(climb.begin(), climb.end()));
  }
  MeshOptions options;
  options.orient = true;  // tets may be given either way round
  return Mesh(nodes, tets, {}, options);
}

// The fluid: a box around the block; it wets all of its surface but the base.
Csf make_fluid(const Mesh& mesh, const Indices& base) {
  Compartment box;
  box.name = "box";
  box.wall_points.resize(8, 3);
  box.wall_points << -20, -20, 0, 80, -20, 0, -20, 80, 0, 80, 80, 0,  //
      -20, -20, 70, 80, -20, 70, -20, 80, 70, 80, 80, 70;
  box.wall_triangles.resize(12, 3);
  box.wall_triangles << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,  //
      2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;
  box.body_faces = mesh.faces_of_region(0);
  const Indices dry = mesh.faces_within(base);
  for (Index face : box.body_faces)
    if (std::find(dry.begin(), dry.end(), face) == dry.end()) box.wetted_faces.push_back(face);
  return Csf(1.0e-6, FluidModel::separate, {box}, 70.0);
}

}  // namespace

int main() try {
  const Mesh mesh = make_block();
  Indices base(side * side);  // the first layer of nodes is held
  std::iota(base.begin(), base.end(), 0);

  Scene scene{mesh, {{0, Material(Law::stable_neo_hookean, 6.0, 0.45, 1.04e-6)}}};
  scene.constraints.fix("base", base);
  scene.csf = make_fluid(mesh, base);

  // Let 300 mL of the 484 mL out, and solve for the new balance.
  Stepper stepper(scene);
  stepper.csf().set_lost_volume(0, 300.0 * mm3_per_ml);
  const SolveReport report = stepper.solve_static();

  const CompartmentState csf = stepper.compartment(0);
  const Vec3 top = stepper.displacement().row(mesh.node_count() - 1 - side * side / 2);
  std::printf("level %.3f mm, air %.3f mL\n", csf.head, csf.air_volume / mm3_per_ml);
  std::printf("middle of the top moved by (%.6f, %.6f, %.6f) mm\n", top.x(), top.y(), top.z());
  std::printf("residual %.1e, min J %.3f, %d Newton iterations, %.3f s\n", report.residual,
              report.smallest_jacobian, report.iterations, report.seconds);
  return report.converged() ? 0 : 1;
} catch (const Error& error) {
  std::fprintf(stderr, "%s: %s\n", to_string(error.code()), error.what());
  return 1;
}
