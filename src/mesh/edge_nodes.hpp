// The nodes on the edges of quadratic tets: their checks, and where they come from.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "brainshift/types.hpp"

namespace brainshift {

// Each edge of a linear mesh, by its two corners in rising order; sorted.
std::vector<std::pair<Index, Index>> edges_of(const Tets& tets);

// Numbers the edges: row t holds the places in `edges` of the edges of tet t.
EdgeNodes number_edges(const Tets& tets, const std::vector<std::pair<Index, Index>>& edges);

// Throws index_out_of_range, size_mismatch (rows), invalid_argument (an edge with two nodes, a node
// on two edges or at a corner).
void check_edge_nodes(const Tets& tets, const EdgeNodes& edge_nodes, Index node_count);

// Throws inverted_element where a tet folds over itself.
void check_folds(const Points& nodes, const Tets& tets, const EdgeNodes& edge_nodes);

// Nodes on the edges 01, 12, 20 of faces that belong to the given tets.
Triangles edge_nodes_of_faces(const Triangles& faces, const Indices& owners, const Tets& tets,
                              const EdgeNodes& edge_nodes);

// The ten nodes of a tet, corners first.
std::array<Index, 10> ten_nodes(const Tets& tets, const EdgeNodes& edge_nodes, Index t);
Eigen::Matrix<double, 10, 3> ten_rows(const Points& nodal, const Tets& tets,
                                      const EdgeNodes& edge_nodes, Index t);

}  // namespace brainshift
