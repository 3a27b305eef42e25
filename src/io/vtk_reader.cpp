#include <cmath>
#include <string>
#include <vector>

#include "brainshift/io.hpp"
#include "file_error.hpp"
#include "vtk_array.hpp"

namespace brainshift::io {

namespace {

constexpr int vtk_tetra = 10, vtk_quadratic_tetra = 24;

// A number that should be whole, for a message.
std::string show(double value) {
  return std::abs(value) < 1e15 && value == std::floor(value) ? std::to_string((long long)(value))
                                                              : std::to_string(value);
}

pugi::xml_node required(const VtkDocument& document, const char* parent, const char* name) {
  for (pugi::xml_node array : document.piece().child(parent).children("DataArray")) {
    if (!name || std::string(array.attribute("Name").value()) == name) return array;
  }
  fail(document.path(),
       std::string("has no array ") + (name ? name : "of coordinates") + " in " + parent);
}

Points read_points(const VtkDocument& document) {
  // The only array of Points; its name is free.
  return read_array(document, required(document, "Points", nullptr),
                    document.count("NumberOfPoints"), 3)
      .values;
}

// Offsets end each cell in the list of corners: c, 2c, 3c ... for cells of c corners.
void check_offsets(const VtkDocument& document, const char* parent, std::size_t cells,
                   std::size_t corners, const char* accepted) {
  const Field offsets = read_array(document, required(document, parent, "offsets"), cells, 1);
  double previous = 0.0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double end = offsets.values(Eigen::Index(cell), 0);
    if (end - previous != double(corners)) {
      fail(document.path(), "cell " + std::to_string(cell) + " has " + show(end - previous) +
                                " corners; only " + accepted + " are read");
    }
    previous = end;
  }
}

template <class Cells>
Cells read_cells(const VtkDocument& document, const char* parent, std::size_t cells,
                 std::size_t points) {
  constexpr int corners = Cells::ColsAtCompileTime;
  const Field list =
      read_array(document, required(document, parent, "connectivity"), corners * cells, 1);
  Cells result(Eigen::Index(cells), corners);
  for (Eigen::Index i = 0; i < list.values.rows(); ++i) {
    const double node = list.values(i, 0);
    if (!(node >= 0.0 && node < double(points)) || node != std::floor(node)) {
      fail(document.path(), "cell " + std::to_string(i / corners) + " refers to node " +
                                show(node) + " of " + std::to_string(points));
    }
    result(i / corners, i % corners) = Index(node);
  }
  return result;
}

std::vector<Field> read_fields(const VtkDocument& document, const char* parent, std::size_t rows) {
  std::vector<Field> fields;
  for (pugi::xml_node array : document.piece().child(parent).children("DataArray")) {
    fields.push_back(read_array(document, array, rows));
  }
  return fields;
}

// True if the tets are quadratic.
bool check_tets(const VtkDocument& document, std::size_t cells) {
  const Field types = read_array(document, required(document, "Cells", "types"), cells, 1);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double type = types.values(Eigen::Index(cell), 0);
    if (type != vtk_tetra && type != vtk_quadratic_tetra) {
      fail(document.path(), "cell " + std::to_string(cell) + " is of VTK type " + show(type) +
                                "; only tets are read, linear (10) or quadratic (24)");
    }
    if (type != types.values(0, 0)) {
      fail(document.path(), "cell " + std::to_string(cell) + " is of VTK type " + show(type) +
                                ", cell 0 of type " + show(types.values(0, 0)) +
                                "; linear and quadratic tets cannot be mixed");
    }
  }
  return cells > 0 && types.values(0, 0) == vtk_quadratic_tetra;
}

}  // namespace

Grid read_vtu(const std::string& path) {
  const VtkDocument document(path, "UnstructuredGrid");
  const std::size_t cells = document.count("NumberOfCells");
  Grid grid;
  grid.points = read_points(document);
  if (check_tets(document, cells)) {
    using TenNodes = Eigen::Matrix<Index, Eigen::Dynamic, 10, Eigen::RowMajor>;
    check_offsets(document, "Cells", cells, 10, "quadratic tets");
    const auto all = read_cells<TenNodes>(document, "Cells", cells, std::size_t(grid.points.rows()));
    grid.tets = all.leftCols<4>();
    grid.edge_nodes = all.rightCols<6>();
  } else {
    check_offsets(document, "Cells", cells, 4, "linear tets");
    grid.tets = read_cells<Tets>(document, "Cells", cells, std::size_t(grid.points.rows()));
  }
  grid.node_fields = read_fields(document, "PointData", std::size_t(grid.points.rows()));
  grid.cell_fields = read_fields(document, "CellData", cells);
  return grid;
}

Grid read_vtp(const std::string& path) {
  const VtkDocument document(path, "PolyData");
  const std::size_t triangles = document.count("NumberOfPolys");
  const std::size_t lines = document.count("NumberOfLines", 0);
  for (const char* other : {"NumberOfVerts", "NumberOfStrips"}) {
    if (document.count(other, 0) != 0) {
      fail(document.path(), std::string(other) + " is not 0; only lines and triangles are read");
    }
  }
  Grid grid;
  grid.points = read_points(document);
  const auto points = std::size_t(grid.points.rows());
  if (lines != 0) {
    check_offsets(document, "Lines", lines, 2, "lines between two nodes");
    grid.lines = read_cells<Lines>(document, "Lines", lines, points);
  }
  check_offsets(document, "Polys", triangles, 3, "triangles");
  grid.triangles = read_cells<Triangles>(document, "Polys", triangles, points);
  grid.node_fields = read_fields(document, "PointData", points);
  grid.cell_fields = read_fields(document, "CellData", lines + triangles);
  return grid;
}

}  // namespace brainshift::io
