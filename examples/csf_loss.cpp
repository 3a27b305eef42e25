// Fluid is lost bit by bit, then comes back: each loss is a change of one setting and a solve. Without
// friction nothing stays behind, whatever the way.
//
// Build:  c++ -std=c++17 csf_loss.cpp $(pkg-config --cflags --libs brainshift) -o csf_loss
// Prints: lost  0 mL   level  70.00 mm   air   0.0 mL   top sinks by 0.000 mm, and so on to
//         lost 450 mL, then: restored; the block is back where it was to 1e-9 mm
#include <cstdio>

#include "block.hpp"

using namespace brainshift;

int main() try {
  Stepper stepper(block_scene());
  const Index top = NODES - 1 - SIDE * SIDE / 2;   // middle of the upper face
  for (double lost = 0.0; lost <= 450.0; lost += 75.0) {
    if (lost > 0.0) stepper.csf().set_lost_volume(0, lost * mm3_per_ml);
    const SolveReport report = stepper.solve_static();
    if (!report.converged()) throw Error(ErrorCode::internal, report.message);
    const CompartmentState csf = stepper.compartment(0);
    std::printf("lost %3.0f mL   level %6.2f mm   air %5.1f mL   top sinks by %.3f mm\n", lost,
                csf.head, csf.air_volume / mm3_per_ml, 0.0 - stepper.displacement()(top, 2));
  }
  stepper.csf().set_full(0);
  if (!stepper.solve_static().converged()) return 1;
  const double left = stepper.displacement().cwiseAbs().maxCoeff();
  std::printf("restored; the block is back where it was to %.0e mm\n", left < 1e-9 ? 1e-9 : left);
  return left < 1e-9 ? 0 : 1;
} catch (const Error& error) {
  std::fprintf(stderr, "%s: %s\n", to_string(error.code()), error.what());
  return 1;
}
