// The fluid's load on the head: Archimedes, unequal levels, the seam, level against volume.
#include <algorithm>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "head_scene.hpp"

namespace dbs {
namespace {

// Volume of a tet below height `head`: cut off the corners above it, one region at a time.
double volume_below(Vec3 (&x)[4], const Vec3& up, double head) {
  std::sort(x, x + 4, [&](const Vec3& a, const Vec3& b) { return a.dot(up) < b.dot(up); });
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return std::abs((b - a).cross(c - a).dot(d - a)) / 6.0;
  };
  const auto cut = [&](const Vec3& a, const Vec3& b) -> Vec3 {
    return a + (b - a) * ((head - a.dot(up)) / (b - a).dot(up));
  };
  const double all = volume(x[0], x[1], x[2], x[3]);
  const auto wet = [&](int i) { return x[i].dot(up) <= head; };
  if (!wet(0)) return 0.0;
  if (wet(3)) return all;
  if (!wet(1)) return volume(x[0], cut(x[0], x[1]), cut(x[0], x[2]), cut(x[0], x[3]));
  if (wet(2)) return all - volume(x[3], cut(x[3], x[0]), cut(x[3], x[1]), cut(x[3], x[2]));
  // Two below: the wedge with edge x0 x1 as three tets.
  const Vec3 a = cut(x[0], x[2]), b = cut(x[0], x[3]), c = cut(x[1], x[2]), d = cut(x[1], x[3]);
  return volume(x[0], x[1], c, d) + volume(x[0], a, c, d) + volume(x[0], a, b, d);
}

// Net force of p = w (head - height) on the wet part of a face, from the cut polygon.
Vec3 face_force(const Vec3 (&x)[3], const Vec3& up, double head, double w) {
  std::vector<Vec3> polygon;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = x[i], &b = x[(i + 1) % 3];
    const double da = head - a.dot(up), db = head - b.dot(up);
    if (da >= 0.0) polygon.push_back(a);
    if (da * db < 0.0) polygon.push_back(a + (b - a) * (da / (da - db)));
  }
  Vec3 force = Vec3::Zero();
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[0], &b = polygon[k - 1], &c = polygon[k];
    const double mean = head - (a + b + c).dot(up) / 3.0;  // linear: mean of the corners
    force -= w * mean * 0.5 * (b - a).cross(c - a);
  }
  return force;
}

Scene scene_with_closed_stem(const Options& o) {
  SceneIds ids;
  Scene scene = make_scene(shipped_head(), o, ids);
  const Head& head = shipped_head();
  const Indices seam = head.brain.faces_within(head.bridge);
  std::vector<Compartment> all;
  for (Index i = 0; i < scene.csf->compartment_count(); ++i) {
    Compartment c = scene.csf->compartment(i);
    c.wetted_faces.clear();
    for (Index f : c.body_faces) {
      if (!std::binary_search(seam.begin(), seam.end(), f)) c.wetted_faces.push_back(f);
    }
    all.push_back(c);
  }
  scene.csf.emplace(scene.csf->density(), scene.csf->model(), all);
  return scene;
}

TEST(Fluid, NetForceIsTheWeightOfTheFluidDisplaced) {
  const Options o = quiet_options();
  const Head& head = shipped_head();
  const Vec3 g = gravity_of(o.elevation), up = -g.normalized();
  Stepper stepper(scene_with_closed_stem(o));
  const double full = full_level(head, g);
  for (double drop : {0.0, 12.3, 40.0, 77.7}) {
    for (Index i : {0, 1}) {
      if (drop > 0.0) stepper.csf().set_level(i, full - drop);
    }
    ASSERT_TRUE(stepper.solve_static().converged());
    const Points x = stepper.positions();
    double volume = 0.0;
    for (Index t = 0; t < head.brain.tet_count(); ++t) {
      Vec3 corners[4];
      for (int a = 0; a < 4; ++a) corners[a] = x.row(head.brain.tets()(t, a)).transpose();
      volume += volume_below(corners, up, full - drop);
    }
    const Vec3 expected = o.csf_density * 1e-9 * g.norm() * volume * up;
    const Vec3 net = stepper.fluid_force().colwise().sum().transpose();
    std::printf("level %.1f mm below full: %.4f L submerged, |net - rho g V| = %.1e of it\n", drop,
                volume * 1e-6, (net - expected).norm() / expected.norm());
    EXPECT_LE((net - expected).norm(), 1e-10 * expected.norm());
  }
}

TEST(Fluid, UnequalLevelsEqualDirectQuadrature) {
  Options o = quiet_options();
  o.fluid = "separate";
  HeadStepper h(o);
  const double heads[2] = {h.full, h.full - 30.0};  // left, right
  h.stepper.csf().set_level(h.compartment(right), heads[right]);
  ASSERT_TRUE(h.stepper.solve_static().converged());
  const Points x = h.stepper.positions();
  const Vec3 g = gravity_of(o.elevation), up = -g.normalized();
  Vec3 expected = Vec3::Zero();
  for (int side : {left, right}) {
    const Compartment& c = h.stepper.csf().compartment(h.compartment(side));
    for (Index f : c.wetted_faces) {
      Vec3 corners[3];
      for (int k = 0; k < 3; ++k) {
        corners[k] = x.row(shipped_head().brain.surface()(f, k)).transpose();
      }
      expected += face_force(corners, up, heads[side], o.csf_density * 1e-9 * g.norm());
    }
  }
  const Vec3 net = h.stepper.fluid_force().colwise().sum().transpose();
  std::printf("levels 30 mm apart: net (%.1f %.1f %.1f) mN, off quadrature by %.1e of it\n",
              net.x(), net.y(), net.z(), (net - expected).norm() / expected.norm());
  EXPECT_LE((net - expected).norm(), 1e-10 * expected.norm());
}

TEST(Fluid, DoesNotPressOnTheSeamOfTheBridge) {
  HeadStepper h(quiet_options());
  const Head& head = shipped_head();
  const Indices seam = head.brain.faces_within(head.bridge);
  ASSERT_FALSE(seam.empty());
  std::vector<int> other_faces(std::size_t(head.brain.node_count()), 0);
  for (Eigen::Index f = 0; f < head.brain.surface().rows(); ++f) {
    if (std::binary_search(seam.begin(), seam.end(), Index(f))) continue;
    for (int k = 0; k < 3; ++k) ++other_faces[std::size_t(head.brain.surface()(f, k))];
  }
  const Points force = h.stepper.fluid_force();
  int inner = 0;
  for (Index node : head.bridge) {
    if (other_faces[std::size_t(node)] > 0) continue;
    ++inner;
    EXPECT_EQ(force.row(node).norm(), 0.0) << "node " << node;
  }
  std::printf("%zu seam faces, %d nodes inside the seam, no pressure on any\n", seam.size(), inner);
  EXPECT_GT(inner, 0);
}

TEST(Fluid, LevelAndVolumeAreInverseAtEquilibrium) {
  HeadStepper by_volume(quiet_options()), by_level(quiet_options());
  const double lost = 17.0 * mm3_per_ml;
  const Index side = by_volume.compartment(right);
  by_volume.stepper.csf().set_lost_volume(side, lost);
  ASSERT_TRUE(by_volume.stepper.solve_static().converged());
  by_level.stepper.csf().set_level(side, by_volume.stepper.compartment(side).head);
  ASSERT_TRUE(by_level.stepper.solve_static().converged());
  double found = 0.0;
  for (Index i : {0, 1}) found += by_level.stepper.compartment(i).lost_volume;
  std::printf("17 mL lost -> level -> %.9f mL lost\n", found / mm3_per_ml);
  EXPECT_NEAR(found, lost, 1e-6 * mm3_per_ml);
}

// Air is what fluid was lost plus what the brain has lost, each since stage 0, at every stage.
TEST(Fluid, AirIsWhatFluidAndBrainHaveLost) {
  for (bool balanced : {true, false}) {
    for (const char* fluid : {"communicating", "separate"}) {
      Options o = quiet_options();
      o.devices = false;
      o.balanced = balanced;
      o.fluid = fluid;
      o.sides = "right";
      o.right = "18mL";
      o.late = 0.0;
      Procedure procedure(shipped_head(), o);
      double worst = 0.0;
      for (const Stage& stage : procedure.plan()) {
        const StageResult r = procedure.run(stage);
        ASSERT_TRUE(r.report.converged()) << r.report.message;
        const double lost = r.fluid[left].lost_volume + r.fluid[right].lost_volume;
        const double air = r.fluid[left].air_volume + r.fluid[right].air_volume;
        worst = std::max(worst, std::abs(air - lost - r.tissue_loss));
        if (stage.label == "1") {   // of the whole fluid, or of the open side's
          const double of = o.fluid == "communicating" ? lost : r.fluid[right].lost_volume;
          EXPECT_NEAR(of, 18.0 * mm3_per_ml, 1e-5 * mm3_per_ml);
        }
      }
      std::printf("%s, %s: air - fluid lost - brain lost at most %.1e mL\n", fluid,
                  balanced ? "balanced" : "free of load", worst / mm3_per_ml);
      EXPECT_LE(worst, 1e-5 * mm3_per_ml);
    }
  }
}

}  // namespace
}  // namespace dbs
