// A bar pressed by a heavy head, more and more, until there is no balance.
#include <Eigen/Eigenvalues>

#include "scenes.hpp"
#include "support/scenes.hpp"

namespace brainshift::stability {

using namespace brainshift::test;

namespace {
constexpr double height = bar_height, head = 10.0;  // mm
}

Scene pressed_bar(const Bar& bar, Law law) {
  const TetShape shape = make_box({20, 20, height + head}, 2, 2, 5);
  Indices regions(std::size_t(shape.tets.rows()), 0);
  const std::size_t head_begins = 6 * 2 * 2 * 4;
  for (std::size_t t = head_begins; t < regions.size(); ++t) regions[t] = 1;
  // Under standard gravity the head presses with Young's modulus of the bar.
  const double density = young / (standard_gravity * head);
  Scene scene{make_mesh(shape, regions),
              {{0, Material(law, young, bar.poisson, 0.0)},
               {1, Material(Law::linear, 1e4 * young, 0.3, density)}},
              Vec3::Zero()};
  scene.balanced_reference = false;
  const auto at_base = [](const Vec3& x) { return x.z() == 0.0; };
  const auto in_head = [](const Vec3& x) { return x.z() >= height; };
  scene.constraints.fix("base", nodes_where(scene.mesh, at_base),
                        {!bar.confined, !bar.confined, true});
  scene.constraints.fix("sides",
                        bar.confined ? all_nodes(scene.mesh) : nodes_where(scene.mesh, in_head),
                        {true, true, false});
  return scene;
}

namespace {

struct Reached {
  double load = 0.0;  // pressure of the head over Young's modulus
  double stretch = 1.0, jacobian = 1.0;
  int solves = 0, iterations = 0;
  const char* tangent = "";
  std::string status = "end of the axis", message;
};

double stretch_of(const Stepper& stepper) {
  const auto below_head = [](const Vec3& x) { return x.z() == height; };
  return 1.0 +
         mean_row(stepper.displacement(), nodes_where(stepper.mesh(), below_head)).z() / height;
}

// Loads until a thousandth more fails, or the bar is pressed to a twentieth.
Reached press(Stepper& stepper) {
  Reached reached;
  for (double step = 0.1; step > 1e-3 * (0.1 + reached.load) && reached.stretch > 0.05;) {
    const double load = reached.load + step;
    stepper.set_gravity({0, 0, -load * standard_gravity});
    const SolveReport report = stepper.solve_static();
    ++reached.solves;
    reached.iterations += report.iterations;
    if (!report.converged()) {
      reached.status = to_string(report.status);
      reached.message = report.message;
      step *= 0.5;
      continue;
    }
    step *= 1.5;
    reached.load = load;
    reached.stretch = stretch_of(stepper);
    reached.jacobian = report.smallest_jacobian;
    reached.tangent = to_string(report.tangent);
  }
  if (reached.stretch <= 0.05) reached.status = "end of the axis", reached.message.clear();
  return reached;
}

// The stretch at which a confined bar of this material stops resisting some wave, at some angle to the
// load (its acoustic tensor loses definiteness): beyond it no uniform state is stable, on any mesh.
double loses_ellipticity(Law law, double poisson) {
  const Material material(law, young, poisson, 0.0);
  for (double stretch = 1.0; stretch > 0.0; stretch -= 1e-3) {
    Mat3 gradient = Mat3::Zero();
    gradient(2, 2) = stretch - 1.0;
    const Eigen::Matrix<double, 9, 9> tangent = material.tangent(gradient);
    for (int degrees = 0; degrees <= 90; ++degrees) {
      const double angle = degrees * std::acos(-1.0) / 180.0;
      Eigen::Matrix<double, 9, 3> wave = Eigen::Matrix<double, 9, 3>::Zero();  // a -> a n^T
      wave.block<3, 3>(0, 0) = std::sin(angle) * Mat3::Identity();
      wave.block<3, 3>(6, 0) = std::cos(angle) * Mat3::Identity();
      const Mat3 acoustic = wave.transpose() * tangent * wave;
      if (Eigen::SelfAdjointEigenSolver<Mat3>(acoustic).eigenvalues()[0] <= 0.0) return stretch;
    }
  }
  return 0.0;
}

}  // namespace

void compression() {
  std::printf("bar,law,element,stretch,load,jacobian,solves,iterations,tangent,status,message\n");
  for (const Bar& bar : bars) {
    for (const Law law : laws) {
      if (bar.confined)
        std::printf("%s,%s,material,%.3f,,,,,,,\n", quoted(bar.name).c_str(), to_string(law),
                    loses_ellipticity(law, bar.poisson));
      for (const Element element : elements) {
        StepperOptions options;
        options.smallest_load_step = 1.0;  // the steps are cut here
        options.max_iterations = 30;
        Stepper stepper(with(pressed_bar(bar, law), element), options);
        const Reached r = press(stepper);
        std::printf("%s,%s,%s,%.4f,%.4g,%.4f,%d,%d,%s,%s,%s\n", quoted(bar.name).c_str(),
                    to_string(law), to_string(element), r.stretch, r.load, r.jacobian, r.solves,
                    r.iterations, r.tangent, r.status.c_str(), quoted(r.message).c_str());
      }
    }
  }
}

}  // namespace brainshift::stability
