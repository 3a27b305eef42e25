// One tet held at its base sags under its weight: touches everything a host links.
#include <cstdio>

#include <brainshift/brainshift.hpp>
#include <brainshift/version.hpp>

int main() {
  using namespace brainshift;
  Points nodes(4, 3);
  nodes << 0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10;
  Tets tets(1, 4);
  tets << 0, 1, 2, 3;
  Scene scene{Mesh(nodes, tets), {{0, Material(Law::corotational, 6.0, 0.45, 1.04e-6)}}};
  scene.constraints.fix("base", {0, 1, 2});
  scene.balanced_reference = false;
  Stepper stepper(std::move(scene));
  const SolveReport report = stepper.solve_static();
  std::printf("libbrainshift %s: %s, top at %.4f mm\n", BRAINSHIFT_VERSION,
              to_string(report.status), stepper.positions()(3, 2));
  return report.converged() && stepper.displacement()(3, 2) < 0.0 ? 0 : 1;
}
