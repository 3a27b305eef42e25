// Tetrahedral mesh: an immutable value, validated at construction, cheap to copy (shared inside).
#pragma once

#include <memory>

#include "brainshift/types.hpp"

namespace brainshift {

struct MeshOptions {
  // Swap two nodes of a tet with negative volume instead of refusing it; reoriented() counts them.
  bool orient = false;
};

// Where points lie in a mesh: the tet holding each point and its barycentric weights.
struct Location {
  Indices tet;                                                        // N; -1: outside the mesh
  Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor> weights;  // N x 4; zero rows outside
};

class Mesh {
 public:
  // nodes: N x 3 (mm). tets: M x 4, positively oriented. regions: M labels of tets, or empty for
  // all 0. Throws Error naming the first culprit: empty, not_finite, index_out_of_range,
  // size_mismatch, degenerate_element, inverted_element, duplicate_element, orphan_node.
  Mesh(Points nodes, Tets tets, Indices regions = {}, MeshOptions options = {});

  Index node_count() const;
  Index tet_count() const;
  const Points& nodes() const;
  const Tets& tets() const;
  const Indices& regions() const;  // M
  Index reoriented() const;        // tets turned by MeshOptions::orient

  double volume() const;              // mm^3
  double volume(Index region) const;  // mm^3; 0 for a region that is not there
  double diameter() const;            // mm; diagonal of the bounding box

  // Boundary faces, outward by the tet that owns them.
  const Triangles& surface() const;     // F x 3 node indices
  const Indices& surface_tets() const;  // F; the owning tet of each face
  // Rows of surface() owned by tets of `region`; rows all of whose nodes are in `nodes`.
  Indices faces_of_region(Index region) const;
  Indices faces_within(const Indices& nodes) const;

  // Connected component of each node (through shared nodes), numbered from 0; and their number.
  const Indices& components() const;  // N
  Index component_count() const;

  // Smallest dihedral angle of every tet, degrees.
  Eigen::VectorXd smallest_dihedrals() const;  // M

  // The tet holding each point. A point within `tolerance` (mm) of the mesh counts as inside; the
  // lowest tet number wins on shared faces. Deformed positions of the nodes may be given.
  Location locate(const Points& points, double tolerance = 1e-9) const;
  Location locate_deformed(const Points& points, const Points& positions,
                           double tolerance = 1e-9) const;

 private:
  struct Data;
  std::shared_ptr<const Data> m_data;
};

}  // namespace brainshift
