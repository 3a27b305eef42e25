// Mesh and obstacle surfaces.
#include <algorithm>

#include "arrays.hpp"
#include "structs.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

brs_surface_options surface_defaults() {
  const SurfaceOptions defaults;
  return {sizeof(brs_surface_options), defaults.grid_spacing, defaults.band};
}

Indices labels(const int32_t* regions, int64_t tet_count) {
  return regions ? indices(regions, tet_count, "regions") : Indices();
}

EdgeNodes in_order(int32_t edges, EdgeNodes edge_nodes) {
  switch (edges) {
    case BRS_EDGES_VTK: return edge_nodes;
    case BRS_EDGES_GMSH: return from_gmsh_order(std::move(edge_nodes));
    default:
      throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                    "there is no order of edges with the number " + std::to_string(edges));
  }
}

Surface make_surface(int32_t kind, Points points, Triangles triangles, SurfaceOptions options) {
  switch (kind) {
    case BRS_SURFACE_CAVITY:
      return Surface::cavity(std::move(points), std::move(triangles), options);
    case BRS_SURFACE_SHEET: return Surface::sheet(std::move(points), std::move(triangles), options);
    default:
      throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                    "there is no kind of surface with the number " + std::to_string(kind));
  }
}

}  // namespace

brs_status brs_mesh_create(brs_context* context, const double* nodes, int64_t node_count,
                           const int32_t* tets, int64_t tet_count, const int32_t* regions,
                           int32_t orient, brs_mesh** mesh) {
  return create(context, mesh, "mesh", [&](brs_context& c) {
    return new brs_mesh(c.context, Mesh(rows<Points>(nodes, node_count, "nodes"),
                                        rows<Tets>(tets, tet_count, "tets"),
                                        labels(regions, tet_count), {orient != 0}));
  });
}

brs_status brs_mesh_create_quadratic(brs_context* context, const double* nodes, int64_t node_count,
                                     const int32_t* tets, const int32_t* edge_nodes,
                                     int64_t tet_count, int32_t edges, const int32_t* regions,
                                     int32_t orient, brs_mesh** mesh) {
  return create(context, mesh, "mesh", [&](brs_context& c) {
    return new brs_mesh(
        c.context,
        Mesh::with_edge_nodes(
            rows<Points>(nodes, node_count, "nodes"), rows<Tets>(tets, tet_count, "tets"),
            in_order(edges, rows<EdgeNodes>(edge_nodes, tet_count, "tets of edge nodes")),
            labels(regions, tet_count), {orient != 0}));
  });
}

brs_status brs_mesh_quadratic(brs_mesh* mesh, brs_mesh** quadratic) {
  return create(mesh, quadratic, "quadratic",
                [](brs_mesh& m) { return new brs_mesh(m.context, m.value.quadratic()); });
}

brs_status brs_mesh_destroy(brs_mesh* mesh) { return destroy_immutable(mesh); }

brs_status brs_mesh_surface(brs_mesh* mesh, const int32_t** triangles, int64_t* count) {
  return guard(mesh, [&](brs_mesh& m) {
    auto& faces = result(triangles, "triangles");
    result(count, "count") = m.value.surface().rows();
    faces = m.value.surface().data();
  });
}

brs_status brs_mesh_faces(brs_mesh* mesh, int32_t region, const int32_t* dry_nodes,
                          int64_t dry_count, int32_t* faces, int64_t capacity, int64_t* count) {
  return guard(mesh, [&](brs_mesh& m) {
    const Indices nodes = indices(dry_nodes, dry_count, "dry nodes");
    const auto culprit = std::find_if(nodes.begin(), nodes.end(), [&](Index node) {
      return node < 0 || node >= m.value.node_count();
    });
    if (culprit != nodes.end())
      throw Refusal(BRS_ERROR_INDEX_OUT_OF_RANGE,
                    "the dry node " + std::to_string(*culprit) + " is not in the mesh of " +
                        std::to_string(m.value.node_count()) + " nodes");
    Indices body = m.value.faces_of_region(region), dry = m.value.faces_within(nodes), wet;
    std::sort(body.begin(), body.end());
    std::sort(dry.begin(), dry.end());
    std::set_difference(body.begin(), body.end(), dry.begin(), dry.end(), std::back_inserter(wet));
    write_list(wet.data(), wet.size(), faces, capacity, count, "faces");
  });
}

brs_status brs_mesh_info_init(brs_mesh_info* info, int64_t struct_size) {
  return init(info, struct_size, brs_mesh_info{});
}

brs_status brs_mesh_describe(brs_mesh* mesh, brs_mesh_info* info) {
  return guard(mesh, [&](brs_mesh& m) {
    const Mesh& v = m.value;
    write(
        info,
        brs_mesh_info{sizeof(brs_mesh_info), v.node_count(), v.tet_count(), v.component_count(),
                      v.reoriented(), v.volume(), v.diameter(), v.nodes().data(), v.tets().data(),
                      v.regions().data(), v.components().data(), v.surface().rows(),
                      v.surface_tets().data(), v.edge_nodes().rows(), v.surface_edge_nodes().rows(),
                      v.edge_nodes().data(), v.surface_edge_nodes().data()},
        "info");
  });
}

brs_status brs_mesh_dihedrals(brs_mesh* mesh, double* degrees, int64_t capacity, int64_t* count) {
  return guard(mesh, [&](brs_mesh& m) {
    const Eigen::VectorXd angles = m.value.smallest_dihedrals();
    write_list(angles.data(), std::size_t(angles.size()), degrees, capacity, count, "degrees");
  });
}

brs_status brs_mesh_locate(brs_mesh* mesh, const double* points, int64_t count, int32_t* tets,
                           double* weights) {
  return guard(mesh, [&](brs_mesh& m) -> brs_status {
    const auto asked = rows<Points>(points, count, "points");
    require_array(tets, count, "tets");
    if (!asked.allFinite()) throw Refusal(BRS_ERROR_NOT_FINITE, "a point is not finite");
    const Location found = m.value.locate(asked);
    if (count > 0) std::memcpy(tets, found.tet.data(), found.tet.size() * sizeof *tets);
    if (weights) write_array(found.weights, weights);
    return remark_outside(*m.context, found.tet);
  });
}

brs_status brs_surface_options_init(brs_surface_options* options, int64_t struct_size) {
  return init(options, struct_size, surface_defaults());
}

brs_status brs_surface_create(brs_context* context, int32_t kind, const double* points,
                              int64_t point_count, const int32_t* triangles, int64_t triangle_count,
                              const brs_surface_options* options, brs_surface** surface) {
  return create(context, surface, "surface", [&](brs_context& c) {
    brs_surface_options given = surface_defaults();
    if (options) given = read(options, given, "options");
    return new brs_surface(c.context,
                           make_surface(kind, rows<Points>(points, point_count, "points"),
                                        rows<Triangles>(triangles, triangle_count, "triangles"),
                                        {given.grid_spacing, given.band}));
  });
}

brs_status brs_surface_destroy(brs_surface* surface) { return destroy_immutable(surface); }

brs_status brs_surface_distance(brs_surface* surface, const double* points, int64_t count,
                                double* distances) {
  return guard(surface, [&](brs_surface& s) {
    const auto asked = rows<Points>(points, count, "points");
    require_array(distances, count, "distances");
    if (!asked.allFinite()) throw Refusal(BRS_ERROR_NOT_FINITE, "a point is not finite");
    for (Eigen::Index i = 0; i < asked.rows(); ++i) {
      const double distance = s.value.distance(asked.row(i).transpose());
      std::memcpy(distances + i, &distance, sizeof distance);
    }
  });
}
