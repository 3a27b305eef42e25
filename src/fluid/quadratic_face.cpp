#include "fluid/quadratic_face.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "fluid/wet_triangle.hpp"
#include "material/mat9.hpp"

namespace brainshift {
namespace {

struct Rule {
  Vec3 b;
  double weight;  // they sum to 1
};

// Exact for degree 5: Radon's seven points.
std::array<Rule, 7> seven_points() {
  const double r = std::sqrt(15.0);
  std::array<Rule, 7> rule;
  rule[0] = {Vec3::Constant(1.0 / 3.0), 9.0 / 40.0};
  std::size_t n = 1;
  for (double sign : {1.0, -1.0}) {
    const double b = (6.0 + sign * r) / 21.0, weight = (155.0 + sign * r) / 1200.0;
    for (int k = 0; k < 3; ++k, ++n) {
      rule[n] = {Vec3::Constant(b), weight};
      rule[n].b[k] = 1.0 - 2.0 * b;
    }
  }
  return rule;
}

// Face coordinates of its six nodes.
Vec3 face_point(int node) {
  if (node < 3) return Vec3::Unit(node);
  return 0.5 * (Vec3::Unit(node - 3) + Vec3::Unit((node - 2) % 3));
}

using Six = Eigen::Matrix<double, 6, 1>;

Six shape(const Vec3& L) {
  Six N;
  for (int a = 0; a < 3; ++a) {
    N[a] = L[a] * (2.0 * L[a] - 1.0);
    N[3 + a] = 4.0 * L[a] * L[(a + 1) % 3];
  }
  return N;
}

// Derivatives by L_1 and L_2, with L_0 = 1 - L_1 - L_2.
Eigen::Matrix<double, 6, 2> shape_slopes(const Vec3& L) {
  Eigen::Matrix<double, 6, 3> d = Eigen::Matrix<double, 6, 3>::Zero();
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    d(a, a) = 4.0 * L[a] - 1.0;
    d(3 + a, a) = 4.0 * L[b];
    d(3 + a, b) = 4.0 * L[a];
  }
  return d.rightCols<2>().colwise() - d.col(0);
}

}  // namespace

QuadraticFace::QuadraticFace(const Points& x, const Mesh& mesh, Index f, const Vec3& up)
    : m_up(up) {
  for (int k = 0; k < 3; ++k) {
    m_nodes[std::size_t(k)] = mesh.surface()(f, k);
    m_nodes[std::size_t(k) + 3] = mesh.surface_edge_nodes()(f, k);
  }
  for (int i = 0; i < 6; ++i) m_x.row(i) = x.row(m_nodes[std::size_t(i)]);
  m_heights = m_x * up;
}

// Calls visit(part, coordinates within the part, depth, face coordinates, weight) at the points of
// quadrature; the weights sum to the wet part of the parameter area 1/2.
template <class Visit>
void QuadraticFace::for_wet_points(double head, bool clip, const Visit& visit) const {
  static const std::array<Rule, 7> rule = seven_points();
  for (const int* part : face_parts) {
    Vec3 depth;
    Mat3 corners;  // columns: face coordinates
    for (int k = 0; k < 3; ++k) {
      depth[k] = head - m_heights[part[k]];
      corners.col(k) = face_point(part[k]);
    }
    const WetPolygon wet = wet_polygon(depth, clip);
    for (int k = 2; k < wet.count; ++k) {
      Mat3 piece;
      piece << wet.corners[0], wet.corners[k - 1], wet.corners[k];
      const double area = 0.5 * 0.25 * std::abs(piece.determinant());
      for (const Rule& point : rule) {
        const Vec3 b = piece * point.b;
        visit(part, b, b.dot(depth), Vec3(corners * b), area * point.weight);
      }
    }
  }
}

QuadraticFace::Load QuadraticFace::integrate(double head, bool clip, Slopes* slopes) const {
  Load load;
  load.depth.fill(Vec3::Zero());
  load.area.fill(Vec3::Zero());
  for_wet_points(
      head, clip, [&](const int* part, const Vec3& b, double depth, const Vec3& L, double weight) {
        load.dry = false;
        const Six N = shape(L);
        const Eigen::Matrix<double, 6, 2> d = shape_slopes(L);
        const Vec3 along = m_x.transpose() * d.col(0), across = m_x.transpose() * d.col(1);
        const Vec3 area = weight * along.cross(across);
        for (std::size_t i = 0; i < 6; ++i) {
          load.area[i] += N[Eigen::Index(i)] * area;
          load.depth[i] += depth * N[Eigen::Index(i)] * area;
        }
        if (!slopes) return;
        Six depth_slope = Six::Zero();  // of the depth by a node's way down
        for (int k = 0; k < 3; ++k) depth_slope[part[k]] = b[k];
        const Mat3 turn_along = weight * skew(along), turn_across = weight * skew(across);
        for (Eigen::Index j = 0; j < 6; ++j) {
          const Mat3 slope = depth * (d(j, 1) * turn_along - d(j, 0) * turn_across) -
                             depth_slope[j] * area * m_up.transpose();
          for (Eigen::Index i = 0; i < 6; ++i) {
            (*slopes)[std::size_t(i)][std::size_t(j)] += N[i] * slope;
          }
        }
      });
  return load;
}

QuadraticFace::Load QuadraticFace::load(double head, bool clip) const {
  return integrate(head, clip, nullptr);
}

QuadraticFace::Load QuadraticFace::load(double head, bool clip, Slopes& slopes) const {
  for (auto& row : slopes) row.fill(Mat3::Zero());
  return integrate(head, clip, &slopes);
}

}  // namespace brainshift
