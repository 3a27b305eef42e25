#include <cstdlib>

#include "brainshift/error.hpp"
#include "brainshift/io.hpp"
#include "robustness/files/memory_file.hpp"
#include "robustness/fuzz/targets.hpp"

namespace brainshift::test {
namespace {

template <class Cells>
void check_cells(const Cells& cells, Eigen::Index nodes) {
  if (cells.size() > 0 && (cells.minCoeff() < 0 || cells.maxCoeff() >= nodes)) std::abort();
}

void check_fields(const std::vector<io::Field>& fields, Eigen::Index rows) {
  for (const io::Field& field : fields) {
    if (field.values.rows() != rows || !field.values.allFinite()) std::abort();
  }
}

template <class Read>
void read_bytes(const std::uint8_t* data, std::size_t size, const Read& read) {
  static const io::MemoryFile file;
  if (!file.write(reinterpret_cast<const char*>(data), size)) std::abort();
  try {
    const io::Grid grid = read(file.path());
    if (!grid.points.allFinite()) std::abort();
    check_cells(grid.tets, grid.points.rows());
    check_cells(grid.lines, grid.points.rows());
    check_cells(grid.triangles, grid.points.rows());
    check_fields(grid.node_fields, grid.points.rows());
    check_fields(grid.cell_fields, grid.tets.rows() + grid.lines.rows() + grid.triangles.rows());
  } catch (const Error& error) {
    if (error.code() != ErrorCode::file) std::abort();
  }
}

}  // namespace

void fuzz_vtu(const std::uint8_t* data, std::size_t size) { read_bytes(data, size, io::read_vtu); }
void fuzz_vtp(const std::uint8_t* data, std::size_t size) { read_bytes(data, size, io::read_vtp); }

}  // namespace brainshift::test
