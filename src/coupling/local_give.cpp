#include "coupling/local_give.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace brainshift {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int ring_points = 6;
constexpr int shrinkings = 4;  // rings of 1, 3/4, 1/2 and 1/4 of the radius are tried

// Acting radius a of a force over a ring of radius e in tets of size h: a^2 = (point h)^2 + (ring e)^2.
// A ring alone in a continuum would have a = e; `point` and `ring` were measured on irregular discs, where
// tests/coupling/lateral_stiffness_test.cpp holds them to the annulus. width: of the ring, over h.
struct Kernel {
  double width, point, ring;
};

Kernel kernel_of(const Tissue& tissue) {
  if (tissue.mesh().is_quadratic()) return {0.5, 0.17, 1.05};
  if (tissue.averages_volume()) return {0.8, 0.415, 1.045};
  return {0.8, 0.527, 1.075};
}

// Mean square extent of a tet's edges across the track, as that of a regular tet would have it from its edge:
// what a mesh makes of a field in the plane across depends on the tets' widths in that plane.
double squared_width(const Mesh& mesh, const Points& x, Index t, const Vec3& along) {
  double sum = 0.0;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < a; ++b) {
      const Vec3 edge = (x.row(mesh.tets()(t, a)) - x.row(mesh.tets()(t, b))).transpose();
      sum += edge.squaredNorm() - along.dot(edge) * along.dot(edge);
    }
  }
  return 1.5 * sum / 6.0;
}

// Size of the tets around a path point: of its own and its neighbours'.
double size_around(const Mesh& mesh, const Points& x, const std::vector<PathPoint>& path,
                   const Vec3& along, std::size_t p) {
  constexpr std::size_t reach = 3;
  const std::size_t from = p > reach ? p - reach : 0, to = std::min(path.size(), p + reach + 1);
  double sum = 0.0, length = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    sum += path[i].length * squared_width(mesh, x, path[i].tet, along);
    length += path[i].length;
  }
  return std::sqrt(sum / length);
}

Vec3 place(const Mesh& mesh, const Points& x, const PathPoint& point) {
  return mesh.interpolation(point.tet, point.weights).of(x);
}

// Regular polygons about a point, the largest first. Those of neighbours are turned against each other.
Points rings_about(const Vec3& centre, const Vec3& along, double radius, std::size_t p) {
  const Vec3 first = along.unitOrthogonal(), second = along.cross(first);
  Points points(shrinkings * ring_points, 3);
  for (int k = 0; k < shrinkings * ring_points; ++k) {
    const int ring = k / ring_points;
    const double e = radius * double(shrinkings - ring) / shrinkings;
    const double angle = 2.0 * pi * (k % ring_points + 0.5 * double(p % 2)) / ring_points;
    points.row(k) = (centre + e * (std::cos(angle) * first + std::sin(angle) * second)).transpose();
  }
  return points;
}

}  // namespace

// At least as wide as the device: in tets finer than that it is the device's own circumference.
// A ring counts as in tissue where it and all smaller ones are in the same body as the point: it
// reaches neither over a gap nor into the other hemisphere.
void spread_ties(const Tissue& tissue, const Points& positions, const Vec3& outward, double radius,
                 std::vector<PathPoint>& path) {
  constexpr int all = shrinkings * ring_points;
  const Mesh& mesh = tissue.mesh();
  std::vector<double> radii;
  Points points(Eigen::Index(path.size()) * all, 3);
  for (std::size_t p = 0; p < path.size(); ++p) {
    const double size = size_around(mesh, positions, path, outward, p);
    radii.push_back(std::max(radius, kernel_of(tissue).width * size));
    points.middleRows(Eigen::Index(p) * all, all) =
        rings_about(place(mesh, positions, path[p]), outward, radii[p], p);
  }
  const Location found = mesh.locate_deformed(points, positions);
  const auto body = [&](Index tet) { return mesh.components()[std::size_t(mesh.tets()(tet, 0))]; };
  for (std::size_t p = 0; p < path.size(); ++p) {
    if (!path[p].ring.empty()) continue;
    std::vector<TetPoint> ring;
    for (int k = all; k-- > 0;) {  // from the smallest
      const std::size_t at = p * all + std::size_t(k);
      if (found.tet[at] < 0 || body(found.tet[at]) != body(path[p].tet)) break;
      ring.push_back({found.tet[at], found.weights.row(Eigen::Index(at)).transpose()});
      if (ring.size() < ring_points) continue;
      path[p].ring = std::move(ring);
      const int shrunk = k / ring_points;
      path[p].spread = radii[p] * double(shrinkings - shrunk) / shrinkings;
      ring.clear();
    }
  }
}

void set_local_give(const Tissue& tissue, double radius, std::vector<PathPoint>& path) {
  const Kernel kernel = kernel_of(tissue);
  const Mesh& mesh = tissue.mesh();
  const Points& rest = mesh.nodes();
  const Vec3 along =
      (place(mesh, rest, path.back()) - place(mesh, rest, path.front())).normalized();
  for (std::size_t p = 0; p < path.size(); ++p) {
    const Material& m = tissue.material_of(path[p].tet);
    const double acting = std::hypot(kernel.point * size_around(mesh, rest, path, along, p),
                                     kernel.ring * path[p].spread);
    const double per_length = (3.0 - 4.0 * m.poisson()) * std::log(std::max(acting / radius, 1.0)) /
                              (8.0 * pi * m.mu() * (1.0 - m.poisson()));
    path[p].give = per_length / path[p].length;
  }
}

}  // namespace brainshift
