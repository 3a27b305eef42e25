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

// A cannula that the frame holds, in tissue that leans against it: what it carries must not depend on the
// size of the tets. With the local give it does so less, and ties are closed by what tissue gives way.
double held_force(const std::array<int, 3>& cells, bool give) {
  Stepper stepper(block_on_base(leaning(0.0), cells));
  EXPECT_TRUE(stepper.solve_static().converged());
  TrackOptions track;
  track.local_give = give;
  const DeviceId id = stepper.insert(make_device("cannula", device_length),
                                     {lead_tip, lead_outward}, whole(), track);
  const SolveReport still = stepper.solve_static();
  EXPECT_LE(still.last_correction, 1e-6) << "nothing moves at insertion";
  stepper.set_gravity(leaning(0.02));
  const SolveReport report = stepper.solve_static();
  EXPECT_TRUE(report.converged()) << report.message;
  const DeviceState d = stepper.device(id);
  EXPECT_LE(d.largest_tie_gap, 1e-9);
  Vec3 sum = Vec3::Zero();
  double off = 0.0;
  for (Eigen::Index p = 0; p < d.path.rows(); ++p) {
    sum += d.path_forces.row(p).transpose();
    const Vec3 from_tip = (d.path.row(p) - d.nodes.row(0)).transpose();
    off = std::max(off, (from_tip - from_tip.dot(lead_outward) * lead_outward).norm());
  }
  EXPECT_EQ(off > 1e-3, give) << off;  // mm by which tissue lies off the rigid line
  return sum.norm();
}

TEST(DeviceInElements, WithTheLocalGiveTheForceOnACannulaDependsLessOnTheMesh) {
  const double fine = held_force({12, 12, 18}, true);
  const double coarse = held_force({4, 4, 6}, true), plain = held_force({4, 4, 6}, false);
  std::printf("force on a held cannula: %.3f mN, coarser tets %.3f with local give, %.3f without\n",
              fine, coarse, plain);
  EXPECT_LT(std::abs(coarse - fine), 0.5 * std::abs(plain - fine));
}

}  // namespace
}  // namespace brainshift::test
