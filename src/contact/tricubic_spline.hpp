// Interpolating tricubic B-spline on a uniform grid: C2, so gradient and Hessian are continuous.
// Unser, Splines: a perfect fit for signal and image processing, IEEE Signal Proc. Mag. 16 (1999).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "brainshift/types.hpp"

namespace brainshift {

struct Grid {
  Vec3 origin;                 // mm; of point (0, 0, 0)
  double spacing;              // mm
  std::array<Index, 3> count;  // points per axis, at least 4

  std::size_t number(Index i, Index j, Index k) const {
    return std::size_t(i) +
           std::size_t(count[0]) * (std::size_t(j) + std::size_t(count[1]) * std::size_t(k));
  }
  std::size_t size() const {
    return std::size_t(count[0]) * std::size_t(count[1]) * std::size_t(count[2]);
  }
  Vec3 point(Index i, Index j, Index k) const { return origin + spacing * Vec3(i, j, k); }
};

class TricubicSpline {
 public:
  struct Sample {
    double value;
    Vec3 gradient;
    Mat3 hessian;
  };

  // values: one per grid point, x fastest; interpolated. The spline is defined up to one cell from
  // the border of the grid.
  TricubicSpline(const Grid& grid, std::vector<double> values)
      : m_grid(grid), m_coefficients(std::move(values)) {
    for (int axis = 0; axis < 3; ++axis) filter(axis);
  }

  // The nearest point at which the spline is defined.
  Vec3 clamp(const Vec3& point) const {
    const Vec3 low = m_grid.point(1, 1, 1);
    const Vec3 high = m_grid.point(m_grid.count[0] - 2, m_grid.count[1] - 2, m_grid.count[2] - 2);
    return point.cwiseMax(low).cwiseMin(high);
  }

  Sample sample(const Vec3& point) const {
    std::array<Basis, 3> basis;
    for (int axis = 0; axis < 3; ++axis)
      basis[std::size_t(axis)] = Basis(m_grid, axis, point[axis]);
    const Basis &bx = basis[0], &by = basis[1], &bz = basis[2];
    // Sums over y and z, four coefficients along x at a time; [y][z]: order of the derivative.
    Eigen::Vector4d sum[3][3];
    for (auto& row : sum)
      for (auto& entry : row) entry.setZero();
    for (Index k = 0; k < 4; ++k)
      for (Index j = 0; j < 4; ++j) {
        const Eigen::Map<const Eigen::Vector4d> line(
            &m_coefficients[m_grid.number(bx.first, by.first + j, bz.first + k)]);
        for (int y = 0; y < 3; ++y)
          for (int z = 0; y + z < 3; ++z) sum[y][z] += (by.weight[y][j] * bz.weight[z][k]) * line;
      }
    const auto derivative = [&](int x, int y, int z) {
      return Eigen::Map<const Eigen::Vector4d>(bx.weight[x]).dot(sum[y][z]);
    };
    Sample s;
    s.value = derivative(0, 0, 0);
    s.gradient << derivative(1, 0, 0), derivative(0, 1, 0), derivative(0, 0, 1);
    s.hessian(0, 0) = derivative(2, 0, 0);
    s.hessian(1, 1) = derivative(0, 2, 0);
    s.hessian(2, 2) = derivative(0, 0, 2);
    s.hessian(0, 1) = derivative(1, 1, 0);
    s.hessian(0, 2) = derivative(1, 0, 1);
    s.hessian(1, 2) = derivative(0, 1, 1);
    s.hessian(1, 0) = s.hessian(0, 1);
    s.hessian(2, 0) = s.hessian(0, 2);
    s.hessian(2, 1) = s.hessian(1, 2);
    return s;
  }

 private:
  // The four cubic B-splines that do not vanish at a coordinate, and their derivatives.
  struct Basis {
    Index first = 0;
    double weight[3][4] = {};  // value, 1/mm, 1/mm^2

    Basis() = default;
    Basis(const Grid& grid, int axis, double coordinate) {
      const double h = grid.spacing, u = (coordinate - grid.origin[axis]) / h;
      // In this order of arguments NaN ends in cell 1, and in the result.
      const double last = double(grid.count[std::size_t(axis)] - 3);
      const Index cell = Index(std::min(last, std::max(1.0, std::floor(u))));
      first = cell - 1;
      const double t = u - cell, s = 1.0 - t;
      const double values[3][4] = {
          {s * s * s / 6, (4 - 3 * t * t * (2 - t)) / 6, (4 - 3 * s * s * (2 - s)) / 6,
           t * t * t / 6},
          {-s * s / 2, t * (3 * t - 4) / 2, s * (4 - 3 * s) / 2, t * t / 2},
          {s, 3 * t - 2, 3 * s - 2, t}};
      const double scale[3] = {1.0, 1.0 / h, 1.0 / (h * h)};
      for (int d = 0; d < 3; ++d)
        for (int i = 0; i < 4; ++i) weight[d][i] = values[d][i] * scale[d];
    }
  };

  // Turns values into coefficients along one axis: (c[i-1] + 4 c[i] + c[i+1]) / 6 = f[i] by
  // elimination, with no second derivative at both ends (c[0] = f[0]). Lines are solved side by
  // side, `stride` at a time, to walk through memory in order.
  void filter(int axis) {
    const std::size_t count = std::size_t(m_grid.count[std::size_t(axis)]);
    std::size_t stride = 1;
    for (int a = 0; a < axis; ++a) stride *= std::size_t(m_grid.count[std::size_t(a)]);
    std::vector<double> upper(count, 0.0);
    for (std::size_t i = 1; i + 1 < count; ++i) upper[i] = 1.0 / (4.0 - upper[i - 1]);
    for (std::size_t base = 0; base < m_coefficients.size(); base += count * stride) {
      double* lines = &m_coefficients[base];
      for (std::size_t i = 1; i + 1 < count; ++i)
        for (std::size_t x = 0; x < stride; ++x)
          lines[i * stride + x] =
              (6.0 * lines[i * stride + x] - lines[(i - 1) * stride + x]) * upper[i];
      for (std::size_t i = count - 2; i >= 1; --i)
        for (std::size_t x = 0; x < stride; ++x)
          lines[i * stride + x] -= upper[i] * lines[(i + 1) * stride + x];
    }
  }

  Grid m_grid;
  std::vector<double> m_coefficients;
};

}  // namespace brainshift
