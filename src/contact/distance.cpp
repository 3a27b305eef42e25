#include "contact/distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "mesh/closest_point.hpp"
#include "mesh/surface_topology.hpp"

namespace brainshift {
namespace {

std::vector<Box> triangle_boxes(const Points& points, const Triangles& triangles) {
  std::vector<Box> boxes(static_cast<std::size_t>(triangles.rows()));
  for (Eigen::Index i = 0; i < triangles.rows(); ++i)
    for (int k = 0; k < 3; ++k) boxes[std::size_t(i)].include(Vec3(points.row(triangles(i, k))));
  return boxes;
}

double with_sign_of(double sign, double size) {
  return sign > 0.0 ? size : (sign < 0.0 ? -size : 0.0);
}

}  // namespace

struct SurfaceDistance::Nearest {
  double squared_distance = std::numeric_limits<double>::infinity();
  Index position = 0;  // in m_corners
  Index triangle = 0;
  Feature feature = Feature::inside;
  Vec3 weights = Vec3::Zero();
  Vec3 point = Vec3::Zero();
};

SurfaceDistance::SurfaceDistance(const Points& points, const Triangles& triangles, SurfaceKind kind)
    : m_kind(kind),
      m_triangles(triangles),
      m_neighbours(neighbours(Index(points.rows()), triangles)),
      m_face_normals(triangles.rows(), 3),
      m_point_normals(Points::Zero(points.rows(), 3)),
      m_at_border(std::size_t(points.rows()), 0),
      m_tree(triangle_boxes(points, triangles)) {
  for (Eigen::Index i = 0; i < triangles.rows(); ++i) {
    Vec3 x[3];
    for (int k = 0; k < 3; ++k) x[k] = points.row(triangles(i, k));
    const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
    m_face_normals.row(i) = normal;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = x[(k + 1) % 3] - x[k], q = x[(k + 2) % 3] - x[k];
      const double angle = std::atan2(p.cross(q).norm(), p.dot(q));
      m_point_normals.row(triangles(i, k)) += angle * normal;
      if (m_neighbours(i, k) >= 0) continue;
      m_at_border[std::size_t(triangles(i, k))] = 1;
      m_at_border[std::size_t(triangles(i, (k + 1) % 3))] = 1;
    }
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i) m_point_normals.row(i).normalize();
  m_corners.reserve(m_tree.items().size());
  for (const Index item : m_tree.items()) {
    const Vec3 a = points.row(triangles(item, 0)), b = points.row(triangles(item, 1)),
               c = points.row(triangles(item, 2));
    const Vec3 centre = (a + b + c) / 3.0;
    const double square = std::max(
        {(a - centre).squaredNorm(), (b - centre).squaredNorm(), (c - centre).squaredNorm()});
    m_corners.push_back({a, b, c, m_face_normals.row(item), centre, std::sqrt(square)});
  }
}

SurfaceDistance::Result SurfaceDistance::operator()(const Vec3& point, Index hint) const {
  Nearest best;
  double reach = best.squared_distance;
  const auto try_triangle = [&](Index position) {
    const Corners& x = m_corners[std::size_t(position)];
    // Most triangles are ruled out by their planes or spheres, at a fraction of the price.
    const double height = x.normal.dot(point - x.a);
    if (height * height > best.squared_distance) return best.squared_distance;
    const double limit = reach + x.radius;
    if ((point - x.centre).squaredNorm() > limit * limit) return best.squared_distance;
    const TrianglePoint near = closest_point(x.a, x.b, x.c, point);
    const Vec3 at = near.weights[0] * x.a + near.weights[1] * x.b + near.weights[2] * x.c;
    const double distance = (at - point).squaredNorm();
    if (distance < best.squared_distance) {
      const Index triangle = m_tree.items()[std::size_t(position)];
      best = {distance, position, triangle, near.feature, near.weights, at};
      reach = std::sqrt(distance);
    }
    return best.squared_distance;
  };
  m_tree.visit_near(point, try_triangle(hint), try_triangle);
  return {signed_distance(best, point - best.point), reach, best.point, best.triangle,
          best.position};
}

double SurfaceDistance::signed_distance(const Nearest& nearest, const Vec3& offset) const {
  const double reach = std::sqrt(nearest.squared_distance);
  const Index triangle = nearest.triangle;
  const Vec3 face_normal = m_face_normals.row(triangle);
  double outward = 0.0;
  if (nearest.feature == Feature::inside) {
    outward = with_sign_of(face_normal.dot(offset), reach);
  } else if (nearest.feature <= Feature::c) {
    const Index node = m_triangles(triangle, int(nearest.feature));
    const double height = m_point_normals.row(node).dot(offset);
    outward = m_at_border[std::size_t(node)] ? height : with_sign_of(height, reach);
  } else {
    const int edge = int(nearest.feature) - int(Feature::ab);
    const Index other = m_neighbours(triangle, edge);
    if (other < 0) return height_past_border(nearest, edge, offset);
    const Vec3 normal = face_normal + m_face_normals.row(other).transpose();
    outward = with_sign_of(normal.dot(offset), reach);
  }
  return m_kind == SurfaceKind::cavity ? -outward : outward;
}

// Past a border edge: the normal is interpolated between the ends of the edge, so that it goes on
// without a jump past the corners of the border; and its part along the face normal is replaced by
// the face's own, so that the value goes on without a jump into that above the triangle.
double SurfaceDistance::height_past_border(const Nearest& nearest, int edge,
                                           const Vec3& offset) const {
  const int from = edge, to = (edge + 1) % 3;
  const Index a = m_triangles(nearest.triangle, from), b = m_triangles(nearest.triangle, to);
  const Vec3 normal = (nearest.weights[from] * m_point_normals.row(a) +
                       nearest.weights[to] * m_point_normals.row(b))
                          .transpose()
                          .normalized();
  const Corners& x = m_corners[std::size_t(nearest.position)];
  const Vec3* corners[3] = {&x.a, &x.b, &x.c};
  const Vec3 face_normal = m_face_normals.row(nearest.triangle);
  const Vec3 away = (*corners[to] - *corners[from]).cross(face_normal).normalized();
  return face_normal.dot(offset) + away.dot(offset) * away.dot(normal);
}

}  // namespace brainshift
