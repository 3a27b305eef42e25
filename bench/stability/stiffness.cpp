// Something far stiffer than the tissue it is in: a device (a beam, tied to its track), and an
// inclusion in the mesh.
#include "axes.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::stability {
namespace {

using namespace brainshift::test;

StepperOptions few_parts() {
  StepperOptions options;
  options.smallest_load_step = 0.25;  // rounding does not shrink with the load
  return options;
}

void print(const char* what, Law law, Element element, double ratio, Stepper& stepper) {
  const SolveReport r = stepper.solve_static();
  std::printf("%s,%s,%s,%.0e,%d,%.2e,%.2e,%.6e,%s,%s\n", what, to_string(law), to_string(element),
              ratio, r.iterations, r.residual, r.tie_gap,
              stepper.displacement().cwiseAbs().maxCoeff(), to_string(r.status),
              quoted(r.message).c_str());
}

// A solid rod as thick as a lead, of `ratio` times the tissue's Young's modulus.
void device(Law law, Element element, double ratio) {
  const double diameter = device_data("3389").outer_diameter;
  const double bending = ratio * young * std::acos(-1.0) * std::pow(diameter, 4) / 64.0;
  Scene scene = block_on_base(Vec3::Zero(), {3, 3, 4});
  scene.materials = {{0, Material(law, young, 0.45, tissue_density)}};
  Stepper stepper(with(scene, element), few_parts());
  stepper.insert(lead(bending), {lead_tip, lead_outward}, wire_only());
  stepper.set_gravity(leaning(0.02));
  print("device", law, element, ratio, stepper);
}

void inclusion(Law law, Element element, double ratio) {
  const TetShape shape = make_box({30, 30, 30}, 3, 3, 3);
  Indices regions(std::size_t(shape.tets.rows()), 0);
  for (std::size_t t = 6 * 13; t < 6 * 14; ++t) regions[t] = 1;  // the cell in the middle
  Scene scene{make_mesh(shape, regions),
              {{0, Material(law, young, 0.45, tissue_density)},
               {1, Material(law, young * ratio, 0.45, tissue_density)}},
              {0.1 * standard_gravity, 0, -0.3 * standard_gravity}};
  scene.balanced_reference = false;
  scene.constraints.fix("base",
                        nodes_where(scene.mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  Stepper stepper(with(scene, element), few_parts());
  print("inclusion", law, element, ratio, stepper);
}

}  // namespace

void stiffness() {
  std::printf("what,law,element,ratio,iterations,residual,tie_gap,motion,status,message\n");
  for (const Law law : laws) {
    for (const Element element : elements) {
      for (const double ratio : {1e0, 1e2, 1e4, 1e6, 1e7, 1e8, 1e9, 1e10, 1e12, 1e14}) {
        const bool beyond = ratio > 1e10;  // hundreds of iterations
        if (beyond && law != Law::corotational) continue;
        if (!beyond || element == Element::linear) device(law, element, ratio);
        inclusion(law, element, ratio);
      }
    }
  }
}

}  // namespace brainshift::stability
