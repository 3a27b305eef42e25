// Rotations of nodes: of rigid motions, of stretches, of linear and of quadratic tets.
#include "tissue/nodal_rotations.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "support/scenes.hpp"

namespace brainshift {
namespace {

Points displaced(const Mesh& mesh, const Mat3& F) {
  return mesh.nodes() * (F - Mat3::Identity()).transpose();
}

void expect_all(const std::vector<Mat3>& rotations, const Mesh& mesh, const Mat3& R) {
  ASSERT_EQ(rotations.size(), std::size_t(mesh.node_count()));
  for (const Mat3& found : rotations) EXPECT_LT((found - R).norm(), 1e-12);
}

TEST(NodalRotations, AreThoseOfARigidMotionAndOfWhatIsStretchedBesides) {
  const Mat3 R = Eigen::AngleAxisd(2.3, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Mat3 stretch = Vec3(1.3, 0.8, 1.1).asDiagonal();
  const Mesh linear = test::make_mesh(test::make_box({10.0, 10.0, 10.0}, 2, 2, 2));
  for (const Mesh& mesh : {linear, linear.quadratic()}) {
    expect_all(nodal_rotations(mesh, Points::Zero(mesh.node_count(), 3)), mesh, Mat3::Identity());
    expect_all(nodal_rotations(mesh, displaced(mesh, R)), mesh, R);
    expect_all(nodal_rotations(mesh, displaced(mesh, R * stretch)), mesh, R);
  }
}

TEST(NodalRotations, FollowABend) {
  const Mesh mesh = test::make_mesh(test::make_box({100.0, 4.0, 4.0}, 50, 2, 2));
  const double radius = 80.0;
  Points u(mesh.node_count(), 3);
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vec3 p = mesh.nodes().row(i);
    const double angle = p.x() / radius, r = radius - p.y();
    u.row(i) = Vec3(r * std::sin(angle), radius - r * std::cos(angle), p.z()) - p;
  }
  const std::vector<Mat3> rotations = nodal_rotations(mesh, u);
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const double angle = mesh.nodes()(i, 0) / radius;
    const Mat3 R = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
    EXPECT_LT((rotations[std::size_t(i)] - R).norm(), 2.0 * 2.0 / radius) << i;   // tets of an end lie on one side
  }
}

}  // namespace
}  // namespace brainshift
