// The fluid on a boundary face of a quadratic tet.
//
// The face is cut into four parts by the nodes on its edges. Over each part the depth is taken to be
// linear between its three nodes, so that waterline and forces follow from the heights of the nodes
// alone, without a jump, and p = 0 on the waterline; shape functions N_i and area vectors are those of
// the curved face. f_i = -w int depth N_i a is then a polynomial of degree 5 on every wet piece and
// integrated exactly; docs/theory.md (23).
#pragma once

#include <array>

#include "brainshift/mesh.hpp"

namespace brainshift {

// Places of the corners of the four parts among the nodes of a face: 0, 1, 2 and those on the edges
// 01, 12, 20.
constexpr int face_parts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};

class QuadraticFace {
 public:
  QuadraticFace(const Points& x, const Mesh& mesh, Index f, const Vec3& up);

  const std::array<Index, 6>& nodes() const { return m_nodes; }
  // clip: only where height < head; otherwise the whole face is wet whatever its height.
  struct Load {
    std::array<Vec3, 6> depth;  // int depth N_i a, mm^3
    std::array<Vec3, 6>
        area;  // int N_i a over the wet part, mm^2: the slope of `depth` by the head
    bool dry = true;
  };
  Load load(double head, bool clip) const;
  // Also slopes[i][j]: d depth_i / dx_j.
  using Slopes = std::array<std::array<Mat3, 6>, 6>;
  Load load(double head, bool clip, Slopes& slopes) const;

 private:
  template <class Visit>
  void for_wet_points(double head, bool clip, const Visit& visit) const;
  Load integrate(double head, bool clip, Slopes* slopes) const;

  std::array<Index, 6> m_nodes;
  Eigen::Matrix<double, 6, 3> m_x;
  Eigen::Matrix<double, 6, 1> m_heights;
  Vec3 m_up;
};

}  // namespace brainshift
