// Exact signed distance from points to a triangulated surface.
#pragma once

#include <vector>

#include "brainshift/types.hpp"
#include "mesh/box_tree.hpp"

namespace brainshift {

enum class SurfaceKind { cavity, sheet };

// The sign is that of the angle-weighted pseudo-normal of the nearest corner, edge or triangle,
// which is right also where the nearest point is shared by several triangles: Baerentzen & Aanaes,
// Signed distance computation using the angle weighted pseudonormal, IEEE TVCG 11 (2005).
//
// Cavity: positive inside (triangles outward). Sheet: positive where the normals point to; past its
// border the height above the tangent plane at the nearest border point, so that the value passes
// through zero, without a jump, on the way around a free edge.
class SurfaceDistance {
 public:
  // The surface must be valid and manifold, a cavity closed (surface_topology.hpp).
  SurfaceDistance(const Points& points, const Triangles& triangles, SurfaceKind kind);

  struct Result {
    double distance;  // mm, signed as above
    double reach;     // mm, to the nearest point of the surface; |distance| except past a border
    Vec3 nearest;     // on the surface
    Index triangle;   // one that holds it
    Index hint;       // for the query of a point close by
  };
  // `hint` of an earlier result makes a query near that point faster; it does not change the
  // distance.
  Result operator()(const Vec3& point, Index hint = 0) const;

 private:
  struct Nearest;
  struct Corners {
    Vec3 a, b, c;
    Vec3 normal;    // unit
    Vec3 centre;    // of a sphere that holds the triangle
    double radius;  // mm
  };
  double signed_distance(const Nearest& nearest, const Vec3& offset) const;
  double height_past_border(const Nearest& nearest, int edge, const Vec3& offset) const;

  SurfaceKind m_kind;
  Triangles m_triangles;          // K x 3
  Triangles m_neighbours;         // K x 3, -1 at a border
  Points m_face_normals;          // K x 3, unit
  Points m_point_normals;         // N x 3, unit, angle-weighted
  std::vector<char> m_at_border;  // N
  BoxTree m_tree;
  std::vector<Corners> m_corners;  // K, in the order of m_tree.items()
};

}  // namespace brainshift
