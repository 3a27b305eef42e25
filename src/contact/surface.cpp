#include "brainshift/surface.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "brainshift/error.hpp"
#include "contact/distance.hpp"
#include "contact/tricubic_spline.hpp"
#include "mesh/surface_topology.hpp"
#include "text.hpp"

namespace brainshift {

struct Surface::Data {
  Points points;
  Triangles triangles;
  TricubicSpline spline;
  SurfaceOptions options;
  SurfaceKind kind;
};

namespace {

constexpr Index block = 4;                // cells per edge of a block of the grid
constexpr double most_grid_points = 2e8;  // 1.6 GB

void check(const SurfaceOptions& options) {
  const auto positive = [](double value, const char* name) {
    if (!(value > 0.0 && std::isfinite(value)))
      throw Error(ErrorCode::invalid_argument, std::string("SurfaceOptions::") + name + " is " +
                                                   text(value) +
                                                   " mm, but must be positive");
  };
  positive(options.grid_spacing, "grid_spacing");
  positive(options.band, "band");
}

// A grid of whole blocks around the surface. The whole band lies around a sheet, which is touched
// from both sides; a cavity is touched from inside, and left only by iterates that overshoot.
Grid grid_around(const Points& points, SurfaceKind kind, const SurfaceOptions& options) {
  const double h = options.grid_spacing;
  const double margin = 4.0 * h + (kind == SurfaceKind::sheet ? options.band : 0.1 * options.band);
  const Vec3 low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const Vec3 size = (high - low).array() + 2.0 * margin;
  const Vec3 blocks = (size / (block * h)).array().ceil();
  const double total = (blocks * block + Vec3::Ones()).prod();
  if (!(total <= most_grid_points)) {
    const Vec3 extent = high - low;
    throw Error(ErrorCode::invalid_argument,
                "SurfaceOptions::grid_spacing " + text(h) + " mm needs " + text(total, 3) +
                    " grid points, more than " + text(most_grid_points) + ", for a surface of " +
                    text(extent[0], 4) + " x " + text(extent[1], 4) + " x " + text(extent[2], 4) +
                    " mm");
  }
  Grid grid{(low + high - blocks * block * h) / 2.0, h, {}};
  for (int axis = 0; axis < 3; ++axis)
    grid.count[std::size_t(axis)] = Index(blocks[axis]) * block + 1;
  return grid;
}

// Distances at the points of the grid, block by block: exact where a block may reach into the band;
// farther away trilinear between the exact distances at the corners of the block.
class DistanceField {
 public:
  DistanceField(const SurfaceDistance& distance, const Grid& grid, double band)
      : m_distance(distance),
        m_grid(grid),
        m_corners{grid.origin, block * grid.spacing, {}},
        // Every point of a block is within half its diagonal of a corner; two cells more, so that
        // the kink between exact and interpolated values has faded from the spline in the band.
        m_far(band + (std::sqrt(0.75) * block + 2.0) * grid.spacing),
        m_values(grid.size()) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      m_corners.count[axis] = (grid.count[axis] - 1) / block + 1;
    m_reach.resize(m_corners.size());
  }

  std::vector<double> values() {
    for (Index k = 0; k < m_corners.count[2]; ++k)
      for (Index j = 0; j < m_corners.count[1]; ++j)
        for (Index i = 0; i < m_corners.count[0]; ++i)
          m_reach[m_corners.number(i, j, k)] = measure(block * i, block * j, block * k);
    for (Index k = 0; k + 1 < m_corners.count[2]; ++k)
      for (Index j = 0; j + 1 < m_corners.count[1]; ++j)
        for (Index i = 0; i + 1 < m_corners.count[0]; ++i) fill(i, j, k);
    return std::move(m_values);
  }

 private:
  double measure(Index i, Index j, Index k) {
    const auto result = m_distance(m_grid.point(i, j, k), m_hint);
    m_hint = result.hint;
    m_values[m_grid.number(i, j, k)] = result.distance;
    return result.reach;
  }

  // Block (i, j, k). Points shared with the next block are left to it, if there is one.
  void fill(Index i, Index j, Index k) {
    double corner[8], nearest = m_far;
    for (int c = 0; c < 8; ++c) {
      const Index x = i + (c & 1), y = j + (c >> 1 & 1), z = k + (c >> 2);
      corner[c] = m_values[m_grid.number(block * x, block * y, block * z)];
      nearest = std::min(nearest, m_reach[m_corners.number(x, y, z)]);
    }
    const Index end[3] = {i + 2 == m_corners.count[0] ? block : block - 1,
                          j + 2 == m_corners.count[1] ? block : block - 1,
                          k + 2 == m_corners.count[2] ? block : block - 1};
    for (Index z = 0; z <= end[2]; ++z)
      for (Index y = 0; y <= end[1]; ++y)
        for (Index x = 0; x <= end[0]; ++x) {
          if (x % block == 0 && y % block == 0 && z % block == 0) continue;  // a corner
          const Index at[3] = {block * i + x, block * j + y, block * k + z};
          if (nearest < m_far)
            measure(at[0], at[1], at[2]);
          else
            m_values[m_grid.number(at[0], at[1], at[2])] =
                trilinear(corner, Vec3(x, y, z) / double(block));
        }
  }

  static double trilinear(const double corner[8], const Vec3& t) {
    double sum = 0.0;
    for (int c = 0; c < 8; ++c)
      sum += corner[c] * (c & 1 ? t[0] : 1 - t[0]) * (c & 2 ? t[1] : 1 - t[1]) *
             (c & 4 ? t[2] : 1 - t[2]);
    return sum;
  }

  const SurfaceDistance& m_distance;
  const Grid& m_grid;
  Grid m_corners;  // of the blocks
  double m_far;    // mm
  std::vector<double> m_values;
  std::vector<double> m_reach;  // of m_corners
  Index m_hint = 0;
};

TricubicSpline spline_of(const Points& points, const Triangles& triangles, SurfaceKind kind,
                         const SurfaceOptions& options) {
  const Grid grid = grid_around(points, kind, options);
  const SurfaceDistance distance(points, triangles, kind);
  return TricubicSpline(grid, DistanceField(distance, grid, options.band).values());
}

}  // namespace

Surface Surface::cavity(Points points, Triangles triangles, SurfaceOptions options) {
  check(options);
  require_closed(points, triangles, "the cavity");
  require_manifold(Index(points.rows()), triangles, "the cavity");
  const double volume = enclosed_volume(points, triangles);
  if (!(volume > 0.0))
    throw Error(ErrorCode::invalid_argument,
                "the triangles of the cavity face inwards: it encloses " + text(volume) +
                    " mm^3");
  TricubicSpline spline = spline_of(points, triangles, SurfaceKind::cavity, options);
  return Surface(std::make_shared<const Data>(
      Data{std::move(points), std::move(triangles), std::move(spline), options,
           SurfaceKind::cavity}));
}

Surface Surface::sheet(Points points, Triangles triangles, SurfaceOptions options) {
  check(options);
  require_triangles(points, triangles, "the sheet");
  require_manifold(Index(points.rows()), triangles, "the sheet");
  TricubicSpline spline = spline_of(points, triangles, SurfaceKind::sheet, options);
  return Surface(std::make_shared<const Data>(
      Data{std::move(points), std::move(triangles), std::move(spline), options,
           SurfaceKind::sheet}));
}

const Points& Surface::points() const { return m_data->points; }
const Triangles& Surface::triangles() const { return m_data->triangles; }
const SurfaceOptions& Surface::options() const { return m_data->options; }
bool Surface::is_cavity() const { return m_data->kind == SurfaceKind::cavity; }

// Off the grid the distance goes on linearly from the nearest point of the grid. The gradient is
// that of this continuation; its Hessian leaves out the third derivatives of the spline.
Surface::Sample Surface::sample(const Vec3& point) const {
  const Vec3 inside = m_data->spline.clamp(point);
  TricubicSpline::Sample s = m_data->spline.sample(inside);
  if (inside != point) {
    const Vec3 step = point - inside;
    s.value += s.gradient.dot(step);
    for (int axis = 0; axis < 3; ++axis)
      if (step[axis] == 0.0) s.gradient[axis] += s.hessian.row(axis).dot(step);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        if (step[a] != 0.0 && step[b] != 0.0) s.hessian(a, b) = 0.0;
  }
  return {s.value, s.gradient, s.hessian};
}

double Surface::distance(const Vec3& point) const { return sample(point).distance; }

}  // namespace brainshift
