// What tets and triangles say about each other without numerics: boundary faces, closed and
// manifold surfaces, components; and the checks of input arrays that all owners of meshes share.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "brainshift/types.hpp"

namespace brainshift {

// `what` names the array in messages, e.g. "nodes", "the wall of compartment left".

// The number of rows as an Index; throws invalid_argument above `limit` rows.
Index checked_count(std::int64_t rows, const std::string& what,
                    std::int64_t limit = std::numeric_limits<Index>::max());
void require_finite(const Points& points, const std::string& what);  // not_finite
// empty, not_finite, index_out_of_range, degenerate_element (no area, repeated points).
void require_triangles(const Points& points, const Triangles& triangles, const std::string& what);
// Runs require_triangles, then throws surface_not_closed unless every edge is passed as often in
// one direction as in the other: then the triangles enclose a volume, also where bodies touch.
void require_closed(const Points& points, const Triangles& triangles, const std::string& what);
// Throws invalid_argument unless the triangles at every edge and around every point form one
// consistently turned sheet (which may have a border).
void require_manifold(Index point_count, const Triangles& triangles, const std::string& what);

// The triangle across each edge (from corner k to the next), -1 at a border; K x 3. The triangles
// must be manifold.
Triangles neighbours(Index point_count, const Triangles& triangles);

// Volume enclosed by a closed surface (mm^3); positive with outward triangles.
double enclosed_volume(const Points& points, const Triangles& triangles);

struct BoundaryFaces {
  Triangles faces;  // F x 3, outward
  Indices tets;     // F; ascending
};

// Faces that belong to one tet only. Throws duplicate_element where three tets meet in a face.
BoundaryFaces boundary_faces(const Tets& tets);

struct Components {
  Indices of_node;  // numbered from 0 in the order of their lowest node
  Index count = 0;
};

Components components(Index node_count, const Tets& tets);
// Quadratic tets, all ten nodes.
Components components(Index node_count, const Tets& tets, const EdgeNodes& edge_nodes);
Components components(Index node_count, const Triangles& triangles);

}  // namespace brainshift
