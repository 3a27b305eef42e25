#include "coupling/local_give.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace brainshift {
namespace {

constexpr double pi = 3.14159265358979323846;

// Radius a force on a line acts with, over the size of the tets: measured on irregular discs.
double acting_part(const Tissue& tissue) {
  if (tissue.mesh().is_quadratic()) return 0.19;
  return tissue.averages_volume() ? 0.485 : 0.666;
}

double volume(const Mesh& mesh, Index t) {
  Mat3 edges;
  for (int a = 1; a < 4; ++a) {
    edges.col(a - 1) =
        (mesh.nodes().row(mesh.tets()(t, a)) - mesh.nodes().row(mesh.tets()(t, 0))).transpose();
  }
  return edges.determinant() / 6.0;
}

// Edge of the regular tet of the mean volume around a path point: of its tet and its neighbours'.
double size_around(const Mesh& mesh, const std::vector<PathPoint>& path, std::size_t p) {
  constexpr std::size_t reach = 3;
  const std::size_t from = p > reach ? p - reach : 0, to = std::min(path.size(), p + reach + 1);
  double sum = 0.0, length = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    sum += path[i].length * volume(mesh, path[i].tet);
    length += path[i].length;
  }
  return std::cbrt(6.0 * std::sqrt(2.0) * sum / length);
}

}  // namespace

void set_local_give(const Tissue& tissue, double radius, std::vector<PathPoint>& path) {
  for (std::size_t p = 0; p < path.size(); ++p) {
    const Material& m = tissue.material_of(path[p].tet);
    const double acting = acting_part(tissue) * size_around(tissue.mesh(), path, p);
    const double per_length = (3.0 - 4.0 * m.poisson()) * std::log(std::max(acting / radius, 1.0)) /
                              (8.0 * pi * m.mu() * (1.0 - m.poisson()));
    path[p].give = per_length / path[p].length;
  }
}

}  // namespace brainshift
