#include "fluid/wet_triangle.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace brainshift {
namespace {

WetMoments whole() {
  WetMoments m;
  m.L.setConstant(1.0 / 6.0);
  m.M.setConstant(1.0 / 24.0);
  m.M.diagonal().setConstant(1.0 / 12.0);
  return m;
}

// Exact moments over the triangle whose corners have the barycentric coordinates b0, b1, b2.
void add_part(const Vec3& b0, const Vec3& b1, const Vec3& b2, WetMoments& m) {
  Mat3 b;
  b << b0, b1, b2;
  const double area = 0.5 * std::abs(b.determinant());
  const Vec3 sum = b0 + b1 + b2;
  m.L += area / 3.0 * sum;
  m.M += area / 12.0 * (b * b.transpose() + sum * sum.transpose());
}

}  // namespace

WetPolygon wet_polygon(const Vec3& depth, bool clip) {
  if (!clip || depth.minCoeff() >= 0.0) {
    return {{Vec3::Unit(0), Vec3::Unit(1), Vec3::Unit(2), Vec3::Zero()}, 3};
  }
  WetPolygon polygon;
  if (depth.maxCoeff() <= 0.0) return polygon;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (depth[i] >= 0.0) polygon.corners[polygon.count++] = Vec3::Unit(i);
    if ((depth[i] > 0.0 && depth[j] < 0.0) || (depth[i] < 0.0 && depth[j] > 0.0)) {
      const double t = depth[i] / (depth[i] - depth[j]);
      polygon.corners[polygon.count++] = (1.0 - t) * Vec3::Unit(i) + t * Vec3::Unit(j);
    }
  }
  return polygon;
}

WetMoments wet_moments(const Vec3& heights, double head, bool clip) {
  const Vec3 depth = Vec3::Constant(head) - heights;
  if (!clip || depth.minCoeff() >= 0.0) return whole();
  const WetPolygon polygon = wet_polygon(depth, clip);
  WetMoments m;
  for (int k = 2; k < polygon.count; ++k) {
    add_part(polygon.corners[0], polygon.corners[k - 1], polygon.corners[k], m);
  }
  return m;
}

Mat3 area_derivative(const Vec3& x0, const Vec3& x1, const Vec3& x2, int k) {
  // a = x0 x x1 + x1 x x2 + x2 x x0, so da/dx0 = [x2 - x1]_x and so on around.
  const Vec3 e = k == 0 ? Vec3(x2 - x1) : k == 1 ? Vec3(x0 - x2) : Vec3(x1 - x0);
  Mat3 cross;
  cross << 0.0, -e.z(), e.y(), e.z(), 0.0, -e.x(), -e.y(), e.x(), 0.0;
  return cross;
}

}  // namespace brainshift
