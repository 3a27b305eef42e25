// Rigid obstacle surfaces: the inner skull, the tentorium, the falx.
#pragma once

#include <memory>

#include "brainshift/types.hpp"

namespace brainshift {

struct SurfaceOptions {
  double grid_spacing = 2.5;  // mm; edge of the distance grid: features below it are rounded off
  double band = 25.0;         // mm; the distance is exact to the grid within this of the surface
};

// Signed distance to a triangulated surface, interpolated by tricubic B-splines on a grid, so that
// gradient and Hessian are continuous: contact normals do not jump where triangles meet.
// Immutable, cheap to copy.
class Surface {
 public:
  // A closed surface with outward triangles: the distance is positive *inside* (a cavity holds what
  // is in it). Throws surface_not_closed, degenerate_element, index_out_of_range, not_finite.
  static Surface cavity(Points points, Triangles triangles, SurfaceOptions options = {});

  // An open two-sided sheet: the distance is positive on the side its normals point to; beyond its
  // border it goes on along the tangent plane there.
  static Surface sheet(Points points, Triangles triangles, SurfaceOptions options = {});

  const Points& points() const;
  const Triangles& triangles() const;
  const SurfaceOptions& options() const;
  bool is_cavity() const;

  struct Sample {
    double distance;  // mm
    Vec3 gradient;    // unit length to the accuracy of the grid
    Mat3 hessian;     // 1/mm
  };
  Sample sample(const Vec3& point) const;
  double distance(const Vec3& point) const;  // mm

 private:
  struct Data;
  explicit Surface(std::shared_ptr<const Data> data) : m_data(std::move(data)) {}
  std::shared_ptr<const Data> m_data;
};

}  // namespace brainshift
