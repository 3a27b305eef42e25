// Devices in every element: tracks, ties and friction.
#include <cstdio>

#include <gtest/gtest.h>

#include "support/elements.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::test {
namespace {

struct Leaned {
  Vec3 tip, middle;  // motion, mm
  double gap = 0.0;
  std::size_t ties = 0;
};

// A lead goes into a block that leans already, is left by its cannula, and leans further.
Leaned lean(Element element, const std::array<int, 3>& cells, double friction) {
  Stepper stepper(with_element(block_on_base(leaning(0.01), cells), element));
  EXPECT_TRUE(stepper.solve_static().converged());
  TrackOptions track;
  track.shear_bound = friction;
  const DeviceId id = stepper.insert(lead(), {lead_tip, lead_outward}, wire_only(), track);
  const SolveReport still = stepper.solve_static();
  EXPECT_TRUE(still.converged()) << still.message;
  EXPECT_LE(still.last_correction, 1e-6)
      << "an unloaded device on the line of its track moves nothing";
  const Points before = stepper.device(id).nodes;
  stepper.set_gravity(leaning(0.03));
  const SolveReport report = stepper.solve_static();
  EXPECT_TRUE(report.converged()) << report.message;
  const DeviceState d = stepper.device(id);
  Points middle(1, 3);
  middle << 20, 20, 40;
  return {(d.nodes.row(0) - before.row(0)).transpose(),
          stepper.displacement_at(middle).values.row(0).transpose(), d.largest_tie_gap,
          std::size_t(d.path.rows())};
}

TEST(DeviceInElements, ALeadMovesAlikeInAllOfThem) {
  for (double friction : {0.0, 0.05}) {
    const Leaned fine = lean(Element::quadratic, {6, 6, 9}, friction);
    for (Element element : all_elements) {
      const Leaned l = lean(element, {4, 4, 6}, friction);
      std::printf(
          "lead in %s tets, friction %g: tip %.3f %.3f %.3f, finer quadratic %.3f %.3f %.3f; "
          "%zu ties, gap %.1e\n",
          name_of(element).c_str(), friction, l.tip.x(), l.tip.y(), l.tip.z(), fine.tip.x(),
          fine.tip.y(), fine.tip.z(), l.ties, l.gap);
      EXPECT_LE(l.gap, 1e-9);
      EXPECT_GE(l.ties, 5u);
      // Linear tets of 10 mm are a fifth too stiff here; quadratic ones are not.
      const double share = element == Element::quadratic ? 0.05 : 0.3;
      EXPECT_LE((l.tip - fine.tip).norm(), share * fine.tip.norm()) << name_of(element);
    }
  }
}

}  // namespace
}  // namespace brainshift::test
