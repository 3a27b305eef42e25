// A block that leans, towards Poisson's ratio 0.5, against quadratic tets on a finer mesh.
#include "scenes.hpp"
#include "support/scenes.hpp"

namespace brainshift::stability {

using namespace brainshift::test;

Scene leaning_cube(Law law, double poisson, int cells) {
  Scene scene{make_mesh(make_box({20, 20, 20}, cells, cells, cells)),
              {{0, Material(law, young, poisson, tissue_density)}},
              {0.3 * standard_gravity, 0, 0}};
  scene.balanced_reference = false;
  scene.constraints.fix("base",
                        nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  return scene;
}

namespace {

constexpr double nearest_reference = 1e-6;

// Displacement of the middle of the top; NaN without balance.
Vec3 top(Stepper& stepper, SolveReport& report) {
  report = stepper.solve_static();
  if (!report.converged()) return Vec3::Constant(std::nan(""));
  return stepper.displacement_at(Vec3(10.0, 10.0, 20.0).transpose()).values.row(0).transpose();
}

void row(Law law, Element element, double below, const Vec3& reference) {
  SolveReport report;
  StepperOptions options;
  options.max_iterations = 30;
  options.smallest_load_step = 0.25;  // rounding does not shrink with the load
  Stepper stepper(with(leaning_cube(law, 0.5 - below, 3), element), options);
  const Vec3 shift = top(stepper, report);
  const double error = (shift - reference).norm() / reference.norm();
  std::printf("%s,%s,%.0e,%.3e,%d,%.2e,%.9f,%.9f,%.9f,%s,%s\n", to_string(law), to_string(element), below,
              error, report.iterations, report.residual, reference.x(), reference.y(), reference.z(), to_string(report.status),
              quoted(report.message).c_str());
}

}  // namespace

void poisson() {
  std::printf("law,element,below_half,error,iterations,residual,reference_x,reference_y,reference_z,status,message\n");
  for (const Law law : laws) {
    Vec3 reference = Vec3::Zero();
    for (const double below : below_half) {
      if (below >= nearest_reference) {  // nearer to 0.5 nothing changes but the rounding
        SolveReport report;
        Stepper finest(with(leaning_cube(law, 0.5 - below, 4), Element::quadratic));
        reference = top(finest, report);
      }
      for (const Element element : elements) row(law, element, below, reference);
    }
  }
}

}  // namespace brainshift::stability
