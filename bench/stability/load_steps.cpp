// The same load in one call or in many: a bar bent far over by gravity across it.
#include "scenes.hpp"
#include "support/scenes.hpp"

namespace brainshift::stability {

using namespace brainshift::test;

Scene bent_bar(Law law) {
  Scene scene{make_mesh(make_box({20, 20, 60}, 2, 2, 6)),
              {{0, Material(law, young, 0.45, tissue_density)}},
              Vec3::Zero()};
  scene.balanced_reference = false;
  scene.constraints.fix("base",
                        nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  return scene;
}

namespace {

void row(Law law, Element element, double load, int calls) {
  Stepper stepper(with(bent_bar(law), element));
  SolveReport last;
  int iterations = 0, steps = 0;
  double reached = 0.0;  // part of the load in balance
  for (int i = 1; i <= calls; ++i) {
    stepper.set_gravity({load * i / calls * standard_gravity, 0, 0});
    last = stepper.solve_static();
    iterations += last.iterations;
    steps += last.load_steps;
    reached = (i - 1 + last.load_factor) / calls;
    if (!last.converged()) break;
  }
  const Vec3 tip =
      stepper.displacement_at(Vec3(10.0, 10.0, 60.0).transpose()).values.row(0).transpose();
  std::printf("%s,%s,%g,%d,%d,%d,%.4f,%.9f,%.9f,%s,%s\n", to_string(law), to_string(element), load,
              calls, iterations, steps, reached, tip.x(), tip.z(), to_string(last.status),
              quoted(last.message).c_str());
}

}  // namespace

void load_steps() {
  std::printf("law,element,load,calls,iterations,load_steps,reached,tip_x,tip_z,status,message\n");
  for (const Law law : laws) {
    for (const Element element : elements) {
      for (const double load : loads_across) {
        for (const int calls : call_counts) row(law, element, load, calls);
      }
    }
  }
}

}  // namespace brainshift::stability
