#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <zlib.h>

#include "base64.hpp"
#include "brainshift/io.hpp"
#include "byte_order.hpp"
#include "file_error.hpp"
#include "output_file.hpp"

namespace brainshift::io {

namespace {

constexpr std::size_t block_size = 1 << 16;  // bytes compressed together
constexpr std::uint8_t vtk_tetra = 10, vtk_quadratic_tetra = 24;

std::string escaped(const std::string& text) {
  std::string result;
  for (char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += c;
    }
  }
  return result;
}

// Shortest text that reads back as the same number, whatever the locale.
std::string to_text(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

class Document {
 public:
  Document(const std::string& path, const char* type) : m_path(path) {
    m_text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + std::string(type) +
             "\" version=\"1.0\" byte_order=\"" + (little_endian() ? "LittleEndian" : "BigEndian") +
             "\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n";
  }
  void line(const std::string& text) { m_text += text + "\n"; }
  void points(const Points& points);
  // Nodes of cells, one row each, and where each cell ends in the list.
  template <class Cells>
  void cells(const Cells& cells, Eigen::Index nodes);
  template <class T>
  void array(const char* type, const std::string& name, Eigen::Index components,
             const std::vector<T>& values);
  void fields(const char* parent, const std::vector<Field>& fields, Eigen::Index rows);
  void save() {
    line("</VTKFile>");
    write_whole_file(m_path, m_text);
  }

 private:
  void field(const Field& field, Eigen::Index rows);
  void compress(const unsigned char* bytes, std::size_t size);

  std::string m_path, m_text;
};

// See ArrayReader::read_compressed() for the layout.
void Document::compress(const unsigned char* bytes, std::size_t size) {
  const std::size_t blocks = (size + block_size - 1) / block_size;
  std::vector<std::uint64_t> header{blocks, block_size, size % block_size};
  std::string packed;
  std::vector<unsigned char> buffer(compressBound(block_size));
  for (std::size_t begin = 0; begin < size; begin += block_size) {
    uLongf used = uLongf(buffer.size());
    const std::size_t length = std::min(block_size, size - begin);
    if (compress2(buffer.data(), &used, bytes + begin, uLong(length), Z_DEFAULT_COMPRESSION) !=
        Z_OK) {
      fail(m_path, "cannot be compressed: out of memory");
    }
    header.push_back(used);
    packed.append(reinterpret_cast<const char*>(buffer.data()), used);
  }
  append_base64(m_text, header.data(), header.size() * sizeof(std::uint64_t));
  append_base64(m_text, packed.data(), packed.size());
}

template <class T>
void Document::array(const char* type, const std::string& name, Eigen::Index components,
                     const std::vector<T>& values) {
  m_text += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + escaped(name) +
            "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"binary\">\n";
  compress(reinterpret_cast<const unsigned char*>(values.data()), values.size() * sizeof(T));
  m_text += "\n</DataArray>\n";
}

void Document::points(const Points& points) {
  if (!points.allFinite()) fail(m_path, "not written: a point has a NaN or infinite coordinate");
  line("<Points>");
  array("Float64", "Points", 3, std::vector<double>(points.data(), points.data() + points.size()));
  line("</Points>");
}

template <class Cells>
void Document::cells(const Cells& cells, Eigen::Index nodes) {
  for (Eigen::Index i = 0; i < cells.rows(); ++i) {
    if (cells.row(i).minCoeff() < 0 || cells.row(i).maxCoeff() >= nodes) {
      fail(m_path, "not written: cell " + std::to_string(i) + " refers to a node outside 0 to " +
                       std::to_string(nodes - 1));
    }
  }
  std::vector<std::int64_t> offsets(std::size_t(cells.rows()));
  for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] = std::int64_t(i + 1) * cells.cols();
  array("Int32", "connectivity", 1, std::vector<Index>(cells.data(), cells.data() + cells.size()));
  array("Int64", "offsets", 1, offsets);
}

void Document::field(const Field& field, Eigen::Index rows) {
  const std::string culprit = "not written: field '" + field.name + "' ";
  if (field.values.rows() != rows || field.values.cols() == 0) {
    fail(m_path, culprit + "is " + std::to_string(field.values.rows()) + " x " +
                     std::to_string(field.values.cols()) + ", expected " + std::to_string(rows) +
                     " rows");
  }
  if (!field.values.allFinite()) fail(m_path, culprit + "holds NaN or infinity");
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values =
      field.values;
  const double* begin = values.data();
  const double* end = begin + values.size();
  if (!field.integer) {
    array("Float64", field.name, values.cols(), std::vector<double>(begin, end));
    return;
  }
  std::vector<std::int32_t> whole;
  whole.reserve(std::size_t(values.size()));
  for (const double* value = begin; value != end; ++value) {
    using Limits = std::numeric_limits<std::int32_t>;
    if (*value != std::floor(*value) || *value < Limits::min() || *value > Limits::max()) {
      fail(m_path, culprit + "holds " + to_text(*value) + ", which is no Int32");
    }
    whole.push_back(std::int32_t(*value));
  }
  array("Int32", field.name, values.cols(), whole);
}

void Document::fields(const char* parent, const std::vector<Field>& fields, Eigen::Index rows) {
  std::set<std::string> names;
  line(std::string("<") + parent + ">");
  for (const Field& one : fields) {
    if (one.name.empty() || !names.insert(one.name).second) {
      fail(m_path, "not written: the field name '" + one.name + "' is empty or used twice");
    }
    field(one, rows);
  }
  line(std::string("</") + parent + ">");
}

}  // namespace

void write_vtu(const std::string& path, const Grid& grid) {
  if (grid.triangles.rows() != 0 || grid.lines.rows() != 0) {
    fail(path, "not written: a VTU holds tets, the grid has lines or triangles");
  }
  const bool quadratic = grid.edge_nodes.rows() > 0;
  if (quadratic && grid.edge_nodes.rows() != grid.tets.rows()) {
    fail(path, "not written: there are edge nodes for " + std::to_string(grid.edge_nodes.rows()) +
                   " of " + std::to_string(grid.tets.rows()) + " tets");
  }
  Document document(path, "UnstructuredGrid");
  document.line("<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
                std::to_string(grid.points.rows()) + "\" NumberOfCells=\"" +
                std::to_string(grid.tets.rows()) + "\">");
  document.fields("PointData", grid.node_fields, grid.points.rows());
  document.fields("CellData", grid.cell_fields, grid.tets.rows());
  document.points(grid.points);
  document.line("<Cells>");
  if (quadratic) {
    Eigen::Matrix<Index, Eigen::Dynamic, 10, Eigen::RowMajor> all(grid.tets.rows(), 10);
    all << grid.tets, grid.edge_nodes;
    document.cells(all, grid.points.rows());
  } else {
    document.cells(grid.tets, grid.points.rows());
  }
  document.array("UInt8", "types", 1,
                 std::vector<std::uint8_t>(std::size_t(grid.tets.rows()),
                                           quadratic ? vtk_quadratic_tetra : vtk_tetra));
  document.line("</Cells>\n</Piece>\n</UnstructuredGrid>");
  document.save();
}

void write_vtp(const std::string& path, const Grid& grid) {
  if (grid.tets.rows() != 0) {
    fail(path, "not written: a VTP holds lines and triangles, the grid has tets");
  }
  const Eigen::Index cells = grid.lines.rows() + grid.triangles.rows();
  Document document(path, "PolyData");
  document.line("<PolyData>\n<Piece NumberOfPoints=\"" + std::to_string(grid.points.rows()) +
                "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(grid.lines.rows()) +
                "\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
                std::to_string(grid.triangles.rows()) + "\">");
  document.fields("PointData", grid.node_fields, grid.points.rows());
  document.fields("CellData", grid.cell_fields, cells);
  document.points(grid.points);
  if (grid.lines.rows() != 0) {
    document.line("<Lines>");
    document.cells(grid.lines, grid.points.rows());
    document.line("</Lines>");
  }
  document.line("<Polys>");
  document.cells(grid.triangles, grid.points.rows());
  document.line("</Polys>\n</Piece>\n</PolyData>");
  document.save();
}

void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& files) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n"
      "<Collection>\n";
  for (const auto& [time, file] : files) {
    if (!std::isfinite(time)) fail(path, "not written: the time of '" + file + "' is not finite");
    text +=
        "<DataSet timestep=\"" + to_text(time) + "\" part=\"0\" file=\"" + escaped(file) + "\"/>\n";
  }
  write_whole_file(path, text + "</Collection>\n</VTKFile>\n");
}

}  // namespace brainshift::io
