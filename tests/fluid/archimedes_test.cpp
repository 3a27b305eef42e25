// The fluid's net force and moment on closed bodies.
#include <gtest/gtest.h>

#include "fluid/fluid_scenes.hpp"

namespace brainshift {
namespace {

Vec3 net(const Points& force) { return force.colwise().sum().transpose(); }

Vec3 net_moment(const Points& force, const Points& x, const Vec3& about) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    sum += (x.row(i).transpose() - about).cross(Vec3(force.row(i).transpose()));
  }
  return sum;
}

TEST(Archimedes, ASubmergedBodyIsLiftedByTheWeightOfItsVolume) {
  const test::BallInCavity scene;
  const Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  for (const Points& x : {scene.mesh.nodes(), test::shaken(scene.mesh, 1.0)}) {
    Vec3 moment;
    const double volume = test::volume_below(scene.mesh, x, 1e3, &moment);
    const Points force = test::force_at(fluid, x, fluid.heads(x));
    // Linear pressure is integrated exactly: round-off of a sum of ~500 terms
    EXPECT_LT((net(force) - Vec3(0, 0, test::weight * volume)).norm(),
              1e-12 * test::weight * volume);
    const Vec3 centre = moment / volume;
    EXPECT_LT(net_moment(force, x, centre).norm(), 1e-12 * test::weight * volume * 30.0);
  }
}

TEST(Archimedes, APartlyWetBodyIsLiftedByWhatIsBelowTheWaterline) {
  test::BallInCavity scene;
  Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  const Points x = test::shaken(scene.mesh, 1.0);
  const double whole = test::volume_below(scene.mesh, x, 1e3);
  for (double level : {-31.0, -20.0, -3.0, 0.0, 0.123, 11.0, 25.0, 33.0}) {
    scene.csf.set_level(0, level);
    fluid.configure(scene.csf, test::gravity_down);
    Vec3 moment;
    const double below = test::volume_below(scene.mesh, x, level, &moment);
    const Points force = test::force_at(fluid, x, fluid.heads(x));
    const double scale = test::weight * whole;
    EXPECT_LT((net(force) - Vec3(0, 0, test::weight * below)).norm(), 1e-10 * scale) << level;
    if (below <= 0.0) continue;
    // Zero moment about the centre of buoyancy
    EXPECT_LT(net_moment(force, x, moment / below).norm(), 1e-10 * scale * 30.0) << level;
  }
}

TEST(Archimedes, TheUpwardDirectionIsThatOfGravity) {
  const test::BallInCavity scene;
  const Vec3 gravity = standard_gravity * Vec3(0.6, -0.64, -0.48);
  const Hydrostatics fluid(scene.mesh, scene.csf, gravity);
  const Points& x = scene.mesh.nodes();
  const double mass = test::fluid_density * scene.mesh.volume();
  EXPECT_LT((net(test::force_at(fluid, x, fluid.heads(x))) + mass * gravity).norm(),
            1e-12 * mass * standard_gravity);
}

TEST(Archimedes, NetForceIsContinuousOverAThousandLevels) {
  test::BallInCavity scene(30.0, 4);
  Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  const Points& x = scene.mesh.nodes();
  const double step = 70.0 / 1000.0;
  Points last;
  for (int i = 0; i <= 1000; ++i) {
    const Points force = test::force_at(fluid, x, {-35.0 + i * step});
    if (i > 0) {
      // |df_i/dhead| <= weight * area around a node: below that of the whole sphere
      EXPECT_LT((force - last).rowwise().norm().maxCoeff(), test::weight * 4 * M_PI * 900 * step)
          << i;
      EXPECT_GE(net(force - last).z(), -1e-12 * test::weight * scene.mesh.volume()) << i;
    }
    last = force;
  }
}

TEST(Archimedes, ForceHasAContinuousSlopeInTheLevel) {
  const test::BallInCavity scene(30.0, 4);
  const Hydrostatics fluid(scene.mesh, scene.csf, test::gravity_down);
  const Points& x = scene.mesh.nodes();
  // 1000 levels; a jump of the slope would show as a second difference of the order of the slope
  // times the step instead of its square.
  const double step = 70.0 / 1000.0;
  const double slope = test::weight * M_PI * 900;
  Points f[3];
  for (int i = 0; i <= 1000; ++i) {
    f[0] = f[1];
    f[1] = f[2];
    f[2] = test::force_at(fluid, x, {-35.0 + i * step});
    if (i >= 2) {
      EXPECT_LT((f[2] - 2.0 * f[1] + f[0]).rowwise().norm().maxCoeff(), 0.02 * slope * step) << i;
    }
  }
}

TEST(Archimedes, FacesThatAreNotWettedFeelNothing) {
  const Mesh mesh = test::make_mesh(test::make_box({10, 10, 10}, 2, 2, 2));
  Compartment c = test::make_compartment("all", test::box_wall({-5, -5, -5}, {15, 15, 15}),
                                         test::all_faces(mesh));
  const Indices base =
      mesh.faces_within(test::nodes_where(mesh, [](const Vec3& p) { return p.z() == 0.0; }));
  Indices wet;
  for (Index f : c.body_faces) {
    if (std::find(base.begin(), base.end(), f) == base.end()) wet.push_back(f);
  }
  c.wetted_faces = wet;
  const Csf csf(test::fluid_density, FluidModel::separate, {c});
  const Hydrostatics fluid(mesh, csf, test::gravity_down);
  const Points force = test::force_at(fluid, mesh.nodes(), fluid.heads(mesh.nodes()));
  // Only the top remains to push: head 15, top at 10, area 100, downwards.
  EXPECT_LT((net(force) - Vec3(0, 0, -test::weight * 5.0 * 100.0)).norm(),
            1e-12 * test::weight * 1e3);
}

}  // namespace
}  // namespace brainshift
