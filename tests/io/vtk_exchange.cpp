// VTK itself at the other end: its files are read here, ours there.
#include <cstdio>
#include <cstdlib>

#include "brainshift/mesh.hpp"
#include "io_test.hpp"

namespace brainshift::io {

namespace {

const std::filesystem::path here = BRAINSHIFT_IO_TESTS;

std::string in_quotes(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

bool vtk_is_installed() {
  return std::system("/usr/bin/python3 -c 'import vtk' >/dev/null 2>&1") == 0;
}

std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return text;
  char buffer[4096];
  while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, pipe))
    text.append(buffer, size);
  return ::pclose(pipe) == 0 ? text : "failed: " + command + "\n" + text;
}

int read_folder(const std::filesystem::path& folder) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string path = entry.path().string(), extension = entry.path().extension().string();
    SCOPED_TRACE(path);
    if (entry.path().stem() == "float_points") {
      Grid expected = two_tets();
      expected.points = expected.points.cast<float>().cast<double>().eval();
      expect_same(read_vtu(path), expected);
    } else if (extension == ".vtu") {
      expect_same(read_vtu(path), two_tets());
    } else if (extension == ".vtp") {
      expect_same(read_vtp(path), three_triangles());
    } else {
      continue;
    }
    ++files;
  }
  return files;
}

std::string hexadecimal(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%a", value);
  return text;
}

// Python writes 0x1.8000000000000p+0 where C writes 0x1.8p+0: both are turned into numbers.
void expect_numbers(std::istringstream& line, const Eigen::MatrixXd& expected) {
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    std::string word;
    line >> word;
    const double value = std::strtod(word.c_str(), nullptr);
    EXPECT_EQ(hexadecimal(value), hexadecimal(expected(i / expected.cols(), i % expected.cols())));
  }
  std::string more;
  EXPECT_FALSE(line >> more) << more;
}

template <class Cells>
void expect_vtk_reads(const std::string& path, const Grid& grid, const Cells& cells,
                      int cell_type) {
  std::istringstream text(output_of("/usr/bin/python3 " + in_quotes(here / "read_with_vtk.py") +
                                    " " + in_quotes(path) + " 2>&1"));
  std::size_t fields = 0, cell = 0;
  bool points_seen = false;
  for (std::string line; std::getline(text, line);) {
    SCOPED_TRACE(line);
    std::istringstream words(line);
    std::string kind, name, type;
    words >> kind;
    if (kind == "errors") {
      expect_numbers(words, Eigen::MatrixXd::Zero(1, 1));
    } else if (kind == "points") {
      expect_numbers(words, grid.points);
      points_seen = true;
    } else if (kind == "cell") {
      Eigen::MatrixXd expected(1, cells.cols() + 1);
      expected << cell_type, cells.row(Eigen::Index(cell++)).template cast<double>();
      expect_numbers(words, expected);
    } else if (kind == "node" || kind == "face") {
      words >> name >> type;
      const Field& field = kind == "node" ? grid.node_field(name) : grid.cell_field(name);
      EXPECT_EQ(type, field.integer ? "int" : "double");
      expect_numbers(words, field.values);
      ++fields;
    } else {
      ADD_FAILURE() << "unexpected output";
    }
  }
  EXPECT_TRUE(points_seen);
  EXPECT_EQ(cell, std::size_t(cells.rows()));
  EXPECT_EQ(fields, grid.node_fields.size() + grid.cell_fields.size());
}

}  // namespace

TEST(VtkExchange, FilesWrittenByVtkAreRead) { EXPECT_EQ(read_folder(here / "fixtures"), 15); }

TEST(VtkExchange, FreshFilesWrittenByVtkAreRead) {
  if (!vtk_is_installed()) GTEST_SKIP() << "python3-vtk9 is not installed";
  const Scratch scratch;
  const std::string said =
      output_of("/usr/bin/python3 " + in_quotes(here / "fixtures/make_fixtures.py") + " " +
                in_quotes(scratch.folder()) + " --raw 2>&1");
  EXPECT_EQ(said, "");
  EXPECT_EQ(read_folder(scratch.folder()), 21);
}

TEST(VtkExchange, VtkReadsOurFiles) {
  if (!vtk_is_installed()) GTEST_SKIP() << "python3-vtk9 is not installed";
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", two_tets());
  expect_vtk_reads(scratch / "a.vtu", two_tets(), two_tets().tets, 10);
  write_vtp(scratch / "a.vtp", three_triangles());
  expect_vtk_reads(scratch / "a.vtp", three_triangles(), three_triangles().triangles, 5);
  write_vtp(scratch / "a.vtp", three_lines());
  expect_vtk_reads(scratch / "a.vtp", three_lines(), three_lines().lines, 3);
}

// The edges of VTK's quadratic tet are ours: on straight edges its middle nodes lie in the middle.
TEST(VtkExchange, VtkFindsTheEdgesOfQuadraticTetsWhereTheyAre) {
  if (!vtk_is_installed()) GTEST_SKIP() << "python3-vtk9 is not installed";
  const Scratch scratch;
  const Mesh mesh = Mesh(two_tets().points, two_tets().tets, {}, {true}).quadratic();
  Grid grid;
  grid.points = mesh.nodes();
  grid.tets = mesh.tets();
  grid.edge_nodes = mesh.edge_nodes();
  write_vtu(scratch / "a.vtu", grid);
  Eigen::Matrix<Index, Eigen::Dynamic, 10, Eigen::RowMajor> cells(grid.tets.rows(), 10);
  cells << grid.tets, grid.edge_nodes;
  expect_vtk_reads(scratch / "a.vtu", grid, cells, 24);
  const Grid again = read_vtu(scratch / "a.vtu");
  EXPECT_EQ(again.tets, grid.tets);
  EXPECT_EQ(again.edge_nodes, grid.edge_nodes);
  EXPECT_EQ(again.points, grid.points);
  EXPECT_EQ(output_of("/usr/bin/python3 " + in_quotes(here / "edges_with_vtk.py") + " " +
                      in_quotes(scratch / "a.vtu") + " 2>&1"),
            "12 edges, largest distance of a node from the middle 0\n");
}

// Several compressed blocks, the last one full and not.
TEST(VtkExchange, VtkReadsOurLargeFiles) {
  if (!vtk_is_installed()) GTEST_SKIP() << "python3-vtk9 is not installed";
  const Scratch scratch;
  for (const int nodes : {8192, 10000}) {
    Grid grid;
    grid.points = Points::Random(nodes, 3);
    grid.tets = two_tets().tets;
    grid.node_fields = {{"noise", Eigen::MatrixXd::Random(nodes, 1), false}};
    write_vtu(scratch / "a.vtu", grid);
    expect_vtk_reads(scratch / "a.vtu", grid, grid.tets, 10);
  }
}

}  // namespace brainshift::io
