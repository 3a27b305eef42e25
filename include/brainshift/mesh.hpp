// Tetrahedral mesh, linear or quadratic: an immutable value, validated at construction, cheap to copy (shared inside).
#pragma once

#include <array>
#include <memory>
#include <utility>

#include "brainshift/types.hpp"

namespace brainshift {

struct MeshOptions {
  // Swap two nodes of a tet with negative volume instead of refusing it; reoriented() counts them.
  bool orient = false;
};

// Where points lie in a mesh: the tet holding each point and its barycentric weights (of a quadratic
// tet: its natural coordinates).
struct Location {
  Indices tet;                                                        // N; -1: outside the mesh
  Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor> weights;  // N x 4; zero rows outside
};

// A value at a point is sum_k weights[k] * (value at nodes[k]), k < count.
struct Interpolation {
  std::array<Index, 10> nodes;
  std::array<double, 10> weights;
  int count = 0;
  Vec3 of(const Points& nodal) const;
};

class Mesh {
 public:
  // nodes: N x 3 (mm). tets: M x 4, positively oriented. regions: M labels of tets, or empty for
  // all 0. Throws Error naming the first culprit: empty, not_finite, index_out_of_range,
  // size_mismatch, degenerate_element, inverted_element, duplicate_element, orphan_node.
  Mesh(Points nodes, Tets tets, Indices regions = {}, MeshOptions options = {});
  // Quadratic tets with a node on each edge; edges may be curved. Also throws invalid_argument where
  // an edge has two nodes or a node two places, inverted_element where a curved tet folds over itself
  // (at a corner or a point of its quadrature).
  static Mesh with_edge_nodes(Points nodes, Tets tets, EdgeNodes edge_nodes, Indices regions = {},
                              MeshOptions options = {});
  // The same linear mesh with quadratic tets: a node in the middle of each edge, after the others.
  // Faces of the surface keep their numbers. A quadratic mesh returns itself.
  Mesh quadratic() const;

  Index node_count() const;
  Index tet_count() const;
  const Points& nodes() const;
  const Tets& tets() const;  // corners
  bool is_quadratic() const;
  const EdgeNodes& edge_nodes() const;  // M x 6; no rows if linear
  bool is_corner(Index node) const;
  const Indices& regions() const;  // M
  Index reoriented() const;        // tets turned by MeshOptions::orient

  double volume() const;              // mm^3; curved tets by their quadrature
  double volume(Index region) const;  // mm^3; 0 for a region that is not there
  double diameter() const;            // mm; diagonal of the bounding box

  // Boundary faces, outward by the tet that owns them.
  const Triangles& surface() const;     // F x 3 node indices, corners
  // F x 3; nodes on the edges 01, 12, 20 of each face; no rows if linear.
  const Triangles& surface_edge_nodes() const;
  const Indices& surface_tets() const;  // F; the owning tet of each face
  // Rows of surface() owned by tets of `region`; rows all of whose nodes are in `nodes`.
  Indices faces_of_region(Index region) const;
  Indices faces_within(const Indices& nodes) const;

  // Connected component of each node (through shared nodes), numbered from 0; and their number.
  const Indices& components() const;  // N
  Index component_count() const;

  // Smallest dihedral angle of every tet between its corners, degrees.
  Eigen::VectorXd smallest_dihedrals() const;  // M

  // The tet holding each point. A point within `tolerance` (mm) of the mesh counts as inside; the
  // lowest tet number wins on shared faces. Deformed positions of the nodes may be given.
  Location locate(const Points& points, double tolerance = 1e-9) const;
  Location locate_deformed(const Points& points, const Points& positions,
                           double tolerance = 1e-9) const;
  // Nodes and weights for a row of a Location.
  Interpolation interpolation(Index tet, const Eigen::Vector4d& weights) const;

 private:
  struct Data;
  explicit Mesh(std::shared_ptr<const Data> data) : m_data(std::move(data)) {}
  static std::shared_ptr<const Data> make(Points nodes, Tets tets, EdgeNodes edge_nodes,
                                          Indices regions, MeshOptions options);
  std::shared_ptr<const Data> m_data;
};

// The columns of EdgeNodes from the order of Gmsh (01, 12, 02, 03, 23, 13).
EdgeNodes from_gmsh_order(EdgeNodes edge_nodes);

}  // namespace brainshift
