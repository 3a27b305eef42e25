// Optional target brainshift_io: VTK XML files for ParaView and 3D Slicer.
// The core takes arrays; other formats go through a converter such as meshio.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "brainshift/types.hpp"

namespace brainshift::io {

// A named array over nodes or cells: values is rows x components.
struct Field {
  std::string name;
  Eigen::MatrixXd values;  // reals; integers read from a file are held exactly up to 2^53
  bool integer = false;    // written as Int32; a value that is none is refused
};

using Lines = Eigen::Matrix<Index, Eigen::Dynamic, 2, Eigen::RowMajor>;

struct Grid {
  Points points;        // mm
  Tets tets;            // VTU: tets
  EdgeNodes edge_nodes; //      no rows: linear; else quadratic tets
  Lines lines;          // VTP: straight lines between two nodes, before
  Triangles triangles;  //      triangles
  std::vector<Field> node_fields;
  std::vector<Field> cell_fields;   // VTP: of lines, then of triangles
  const Field& node_field(const std::string& name) const;  // throws Error(file) naming it
  const Field& cell_field(const std::string& name) const;
};

// All throw Error(file) in one sentence with the path (and what is wrong with its content); NaN and
// infinity are refused in reading and in writing. The readers take ascii, binary and appended
// arrays, with and without zlib, of every number type of VTK. Writers write zlib-compressed binary
// (Float64), and to a temporary beside the target and rename: an old file stays whole on failure.
// UnstructuredGrid of tets, all of them linear (type 10) or all quadratic (type 24).
Grid read_vtu(const std::string& path);
Grid read_vtp(const std::string& path);  // PolyData of lines and triangles
void write_vtu(const std::string& path, const Grid& grid);
void write_vtp(const std::string& path, const Grid& grid);
// A time series; entries: time (stage number) and file name relative to the .pvd.
void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& files);

}  // namespace brainshift::io
