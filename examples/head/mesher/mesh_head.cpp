// Meshes a body that a signed distance describes, parted into left and right by the mid-surface
// x = x_m(y, z) and optionally cut by a plane z = floor, with CGAL Mesh_3.
//
//   mesh_head DOMAIN OUTPUT EDGE_SIZE FACET_SIZE FACET_DISTANCE CELL_SIZE [surface]
//
// With "surface" the tets are not improved: only the facets will be used.
//
// DOMAIN (text): dims, origin, spacing, floor, a point inside and a radius about it that holds the body,
// 15 coefficients of x_m, name of the raw float32 file (z fastest), number of protected polylines, and
// per polyline its number of points and the points.
// OUTPUT (text): "nodes n" with x y z per line, "tets m" with four nodes and the label per line
// (1 left, 2 right). Lengths in mm.
//
// CGAL's Mesh_3 is under the GPL. This program makes data; the library does not use it. It is
// sequential and its random numbers are seeded, so a mesh can be made again node by node.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace params = CGAL::parameters;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Polyline = std::vector<Point>;
using Domain = CGAL::Mesh_domain_with_polyline_features_3<CGAL::Labeled_mesh_domain_3<Kernel>>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index,
                                                        Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

// The body: 0 outside, 1 left of the mid-surface, 2 right of it.
class Body {
 public:
  explicit Body(const std::string& path) {
    std::ifstream in(path);
    for (int& n : m_dims) in >> n;
    for (double& o : m_origin) in >> o;
    in >> m_spacing >> m_floor;
    for (double& c : m_centre) in >> c;
    in >> m_radius;
    for (double& c : m_mid) in >> c;
    std::string raw;
    std::size_t count = 0;
    in >> raw >> count;
    if (!in) throw std::runtime_error("cannot read " + path);
    read_polylines(in, count);
    m_distance.resize(std::size_t(m_dims[0]) * m_dims[1] * m_dims[2]);
    std::ifstream data(raw, std::ios::binary);
    data.read(reinterpret_cast<char*>(m_distance.data()), m_distance.size() * sizeof(float));
    if (!data) throw std::runtime_error("cannot read " + raw);
  }

  int label(const Point& p) const {
    if (p.z() <= m_floor || distance(p) >= 0) return 0;
    return p.x() < mid(p.y(), p.z()) ? 1 : 2;
  }

  // A point near the middle of the body; CGAL shoots its first rays from there.
  Kernel::Sphere_3 bounding_sphere() const {
    return Kernel::Sphere_3(Point(m_centre[0], m_centre[1], m_centre[2]), m_radius * m_radius);
  }
  const std::vector<Polyline>& polylines() const { return m_polylines; }

 private:
  void read_polylines(std::istream& in, std::size_t count) {
    for (; count > 0; --count) {
      std::size_t points = 0;
      in >> points;
      Polyline line;
      for (double x, y, z; line.size() < points && in >> x >> y >> z;) line.emplace_back(x, y, z);
      if (!in) throw std::runtime_error("polyline cut short");
      m_polylines.push_back(line);
    }
  }

  // x_m = sum c_k (y/100)^i (z/100)^j over i + j <= 4, i slow, j fast (midsurface.py).
  double mid(double y, double z) const {
    double sum = 0, power_y = 1;
    int k = 0;
    for (int i = 0; i <= 4; ++i, power_y *= y / 100) {
      double power = power_y;
      for (int j = 0; i + j <= 4; ++j, power *= z / 100) sum += m_mid[k++] * power;
    }
    return sum;
  }

  // Trilinear interpolation; far outside beyond the grid.
  double distance(const Point& p) const {
    std::array<int, 3> cell;
    std::array<double, 3> t;
    for (int d = 0; d < 3; ++d) {
      const double s = (p[d] - m_origin[d]) / m_spacing;
      cell[d] = int(std::floor(s));
      t[d] = s - cell[d];
      if (cell[d] < 0 || cell[d] + 1 >= m_dims[d]) return 1e3;
    }
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::array<std::size_t, 3> index;
      for (int d = 0; d < 3; ++d) {
        const int up = (corner >> d) & 1;
        weight *= up ? t[d] : 1 - t[d];
        index[d] = std::size_t(cell[d] + up);
      }
      sum += weight * m_distance[(index[0] * m_dims[1] + index[1]) * m_dims[2] + index[2]];
    }
    return sum;
  }

  std::array<int, 3> m_dims;
  std::array<double, 3> m_origin;
  double m_spacing = 1, m_floor = 0;
  std::array<double, 3> m_centre;
  double m_radius = 0;
  std::array<double, 15> m_mid;
  std::vector<float> m_distance;
  std::vector<Polyline> m_polylines;
};

void write(const Complex& complex, const std::string& path) {
  std::FILE* out = std::fopen(path.c_str(), "w");
  if (!out) throw std::runtime_error("cannot write " + path);
  std::map<Triangulation::Vertex_handle, int> index;
  std::vector<Point> nodes;
  std::vector<std::array<int, 5>> tets;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
       ++cell) {
    std::array<int, 5> tet;
    for (int i = 0; i < 4; ++i) {
      const auto vertex = cell->vertex(i);
      const auto [entry, is_new] = index.emplace(vertex, int(nodes.size()));
      if (is_new) nodes.push_back(vertex->point().point());
      tet[i] = entry->second;
    }
    tet[4] = complex.subdomain_index(cell);
    tets.push_back(tet);
  }
  std::fprintf(out, "nodes %zu\n", nodes.size());
  for (const Point& p : nodes) std::fprintf(out, "%.17g %.17g %.17g\n", p.x(), p.y(), p.z());
  std::fprintf(out, "tets %zu\n", tets.size());
  for (const auto& t : tets) std::fprintf(out, "%d %d %d %d %d\n", t[0], t[1], t[2], t[3], t[4]);
  std::fclose(out);
  std::cout << nodes.size() << " nodes, " << tets.size() << " tets\n";
}

int run(char** argv, bool surface_only) {
  const Body body(argv[1]);
  const double edge = std::atof(argv[3]), facet = std::atof(argv[4]);
  const double chord = std::atof(argv[5]), cell = std::atof(argv[6]);

  CGAL::get_default_random() = CGAL::Random(0);
  Domain domain(
      params::function = [&](const Point& p) { return body.label(p); },
      params::bounding_object = body.bounding_sphere(), params::p_rng = &CGAL::get_default_random(),
      params::relative_error_bound = 1e-7);
  domain.add_features(body.polylines().begin(), body.polylines().end());

  Criteria criteria(params::edge_size = edge, params::facet_angle = 25, params::facet_size = facet,
                    params::facet_distance = chord, params::cell_radius_edge_ratio = 2.5,
                    params::cell_size = cell);
  // No time limits: a limit would make the result depend on the machine. Left, right and outside
  // meet along a curve, so the surfaces are not manifold there; asking for it never ends.
  Complex complex = CGAL::make_mesh_3<Complex>(domain, criteria, params::no_perturb(),
                                               params::no_exude(), params::non_manifold());
  if (!surface_only) {
    CGAL::perturb_mesh_3(complex, domain, params::sliver_bound = 12, params::time_limit = 0);
    CGAL::exude_mesh_3(complex, params::sliver_bound = 15, params::time_limit = 0);
  }
  write(complex, argv[2]);
  return 0;
}

int main(int argc, char** argv) {
  if (argc != 7 && argc != 8) {
    std::cerr << "usage: mesh_head DOMAIN OUTPUT EDGE_SIZE FACET_SIZE FACET_DISTANCE CELL_SIZE "
                 "[surface]\n";
    return 2;
  }
  try {
    return run(argv, argc == 8);
  } catch (const std::exception& error) {
    std::cerr << "mesh_head: " << error.what() << '\n';
    return 1;
  }
}
