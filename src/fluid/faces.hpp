// One boundary face at given positions, as the fluid sees it.
#pragma once

#include <Eigen/Geometry>

#include "brainshift/types.hpp"
#include "fluid/wet_triangle.hpp"

namespace brainshift {

struct Face {
  Index nodes[3];
  Vec3 x[3];
  Vec3 heights;  // along `up`
  Vec3 area;     // (x1-x0) x (x2-x0): twice the outward area vector

  Face(const Points& points, const Triangles& faces, Index f, const Vec3& up) {
    for (int k = 0; k < 3; ++k) {
      nodes[k] = faces(f, k);
      x[k] = points.row(nodes[k]).transpose();
      heights[k] = x[k].dot(up);
    }
    area = (x[1] - x[0]).cross(x[2] - x[0]);
  }
};

}  // namespace brainshift
