#include <sys/resource.h>
#include <unistd.h>
#include <csignal>
#include <limits>

#include "io_test.hpp"

namespace brainshift::io {

namespace {

const std::string ascii_tets = std::string(BRAINSHIFT_IO_TESTS) + "/fixtures/ascii_32.vtu";
const std::string ascii_triangles = std::string(BRAINSHIFT_IO_TESTS) + "/fixtures/ascii_32.vtp";
const std::string zlib_tets = std::string(BRAINSHIFT_IO_TESTS) + "/fixtures/inline_zlib_32.vtu";

// The fixture with one piece of its text replaced is refused, and `words` say why.
void expect_refused_after(const std::string& fixture, const std::string& old_text,
                          const std::string& new_text, const std::string& words) {
  const Scratch scratch;
  std::string text = read_text(fixture);
  const std::size_t at = text.find(old_text);
  ASSERT_NE(at, std::string::npos) << old_text;
  text.replace(at, old_text.size(), new_text);
  const bool triangles = fixture.substr(fixture.size() - 1) == "p";
  const std::string path = scratch / (triangles ? "a.vtp" : "a.vtu");
  write_text(path, text);
  expect_refused(path, words, [&] { triangles ? read_vtp(path) : read_vtu(path); });
}

}  // namespace

TEST(Refused, FilesThatAreNone) {
  const Scratch scratch;
  expect_refused(scratch / "none.vtu", "no such file", [&] { read_vtu(scratch / "none.vtu"); });
  const std::string folder = scratch.folder().string();
  expect_refused(folder, "not a regular file", [&] { read_vtu(folder); });
  expect_refused("/dev/zero", "not a regular file", [&] { read_vtu("/dev/zero"); });
  write_text(scratch / "empty.vtu", "");
  expect_refused(scratch / "empty.vtu", "not whole XML", [&] { read_vtu(scratch / "empty.vtu"); });
  write_text(scratch / "other.vtu", "<html></html>");
  expect_refused(scratch / "other.vtu", "VTKFile", [&] { read_vtu(scratch / "other.vtu"); });
  expect_refused(ascii_triangles, "holds a VTK 'PolyData'", [&] { read_vtu(ascii_triangles); });
}

TEST(Refused, OtherCells) {
  expect_refused_after(ascii_tets, "10 10\n", "10 12\n", "cell 1 is of VTK type 12");
  expect_refused_after(ascii_tets, "4 8\n", "4 9\n", "cell 1 has 5 corners");
  expect_refused_after(ascii_tets, "4 8\n", "8 4\n", "cell 0 has 8 corners");
  expect_refused_after(ascii_triangles, "3 6 9", "4 6 9", "cell 0 has 4 corners");
  expect_refused_after(ascii_triangles, "NumberOfLines=\"0\"", "NumberOfLines=\"1\"",
                       "array 'offsets' has room for 0 values");
  expect_refused_after(ascii_triangles, "NumberOfStrips=\"0\"", "NumberOfStrips=\"1\"",
                       "NumberOfStrips is not 0");
}

TEST(Refused, NodesThatAreNotThere) {
  expect_refused_after(ascii_tets, "0 1 2 3", "0 1 2 5", "cell 0 refers to node 5 of 5");
  expect_refused_after(ascii_tets, "0 1 2 3", "0 1 -2 3", "cell 0 refers to node -2 of 5");
  expect_refused_after(ascii_triangles, "0 2 1", "0 2 9", "cell 0 refers to node 9 of 5");
}

TEST(Refused, NumbersThatAreNone) {
  const std::string first = "0 0 0 0.1";
  expect_refused_after(ascii_tets, first, "0 0 nan 0.1", "'displacement' holds NaN");
  expect_refused_after(ascii_tets, first, "0 0 inf 0.1",
                       "'displacement' holds NaN or infinity in row 0");
  expect_refused_after(ascii_tets, first, "0 0 0,5 0.1", "holds '0,5', which is no Float64");
  expect_refused_after(ascii_tets, first, "0 0 zero 0.1", "holds 'zero', which is no Float64");
  expect_refused_after(ascii_tets, first, "0 0 0.1", "holds 14 values, expected 15");
  expect_refused_after(ascii_tets, first, "0 0 0 0 0.1", "more values than the 15 expected");
  expect_refused_after(ascii_tets, "-1 0 -1 0 -1", "-1 0 -1 0 -129", "'-129', which is no Int8");
}

TEST(Refused, ArraysThatAreMissing) {
  expect_refused_after(ascii_tets, "Name=\"types\"", "Name=\"kinds\"", "no array types in Cells");
  expect_refused_after(ascii_tets, "Name=\"offsets\"", "Name=\"ends\"",
                       "no array offsets in Cells");
  expect_refused_after(ascii_tets, "Name=\"connectivity\"", "Name=\"corners\"",
                       "no array connectivity in Cells");
  expect_refused_after(ascii_tets, "<Points>", "<Points></Points><Other>", "not whole XML");
}

TEST(Refused, CountsThatExceedTheFile) {
  const std::string points = "NumberOfPoints=\"5\"", cells = "NumberOfCells=\"2\"";
  expect_refused_after(ascii_tets, points, "NumberOfPoints=\"2000000000\"", "expected 6000000000");
  expect_refused_after(ascii_tets, points, "NumberOfPoints=\"99999999999\"", "0 to 2147483647");
  expect_refused_after(ascii_tets, points, "NumberOfPoints=\"-5\"", "NumberOfPoints is '-5'");
  expect_refused_after(ascii_tets, points, "Points=\"5\"", "lacks NumberOfPoints");
  expect_refused_after(ascii_tets, cells, "NumberOfCells=\"2000000000\"", "expected 2000000000");
  expect_refused_after(zlib_tets, points, "NumberOfPoints=\"2000000000\"", "expected 48000000000");
  expect_refused_after(ascii_tets, "NumberOfComponents=\"3\"", "NumberOfComponents=\"9999999999\"",
                       "has '9999999999' components");
}

// A header that agrees with its counts, but promises more than so few bytes can hold.
TEST(Refused, ABombIsNotUnpacked) {
  const Scratch scratch;
  std::string text = read_text(zlib_tets);
  const std::string old_header = "BAAAACAAAAAYAAAADgAAAA4AAAAOAAAAGgAAAA==";
  // UInt32: 1 block of 2400000000 bytes, none partial, packed into 14.
  const std::string header = "AQAAAAAYDY8AAAAADgAAAA==";
  const std::size_t at = text.find(old_header);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, old_header.size(), header);
  const std::string count = "NumberOfPoints=\"5\"";
  text.replace(text.find(count), count.size(), "NumberOfPoints=\"100000000\"");
  const std::string path = scratch / "a.vtu";
  write_text(path, text);
  expect_refused(path, "array 'Points' promises 2400000000 bytes", [&] { read_vtu(path); });
}

TEST(Refused, UnknownEncodings) {
  expect_refused_after(zlib_tets, "vtkZLibDataCompressor", "vtkLZ4DataCompressor",
                       "vtkLZ4DataCompressor");
  expect_refused_after(zlib_tets, "header_type=\"UInt32\"", "header_type=\"UInt16\"",
                       "header_type 'UInt16'");
  expect_refused_after(zlib_tets, "LittleEndian", "MiddleEndian", "byte_order 'MiddleEndian'");
  expect_refused_after(zlib_tets, "type=\"Float32\"", "type=\"Bit\"", "unknown type 'Bit'");
  expect_refused_after(zlib_tets, "format=\"binary\"", "format=\"morse\"",
                       "unknown format 'morse'");
  expect_refused_after(zlib_tets, "format=\"binary\"", "format=\"appended\" offset=\"0\"",
                       "there is no AppendedData");
}

TEST(Refused, GridsThatHoldTogetherBadly) {
  const Scratch scratch;
  const std::string path = scratch / "a.vtu";
  const auto refused = [&](const Grid& grid, const std::string& words) {
    expect_refused(path, words, [&] { write_vtu(path, grid); });
    EXPECT_EQ(scratch.file_count(), 0u);
  };
  Grid grid = two_tets();
  grid.points(4, 1) = std::numeric_limits<double>::quiet_NaN();
  refused(grid, "a point has a NaN");
  grid = two_tets();
  grid.node_fields[1].values(2, 0) = std::numeric_limits<double>::infinity();
  refused(grid, "field 'pressure' holds NaN or infinity");
  grid = two_tets();
  grid.node_fields[0].values.conservativeResize(4, 3);
  refused(grid, "field 'displacement' is 4 x 3, expected 5 rows");
  grid = two_tets();
  grid.node_fields[1].name = "displacement";
  refused(grid, "'displacement' is empty or used twice");
  grid = two_tets();
  grid.tets(1, 1) = 5;
  refused(grid, "cell 1 refers to a node outside 0 to 4");
  grid = two_tets();
  grid.cell_fields[0].values(0, 0) = 0.5;
  refused(grid, "field 'region' holds 0.5, which is no Int32");
  refused(three_triangles(), "a VTU holds tets");
}

TEST(Refused, PlacesThatCannotBeWritten) {
  const Scratch scratch;
  const std::string nowhere = scratch / "none/a.vtu";
  expect_refused(nowhere, "No such file or directory", [&] { write_vtu(nowhere, two_tets()); });
  const std::string folder = scratch.folder().string();
  expect_refused(folder, "not a regular file", [&] { write_vtu(folder, two_tets()); });
  expect_refused("/dev/null", "not a regular file", [&] { write_pvd("/dev/null", {}); });
}

TEST(Refused, FoldersWithoutPermission) {
  const Scratch scratch;
  using Perms = std::filesystem::perms;
  std::filesystem::permissions(scratch.folder(), Perms::owner_read | Perms::owner_exec |
                                                     Perms::others_read | Perms::others_exec);
  const bool root = ::geteuid() == 0;   // root may write anywhere: nobody tries instead
  constexpr uid_t nobody = 65534;
  if (root) {
    ASSERT_EQ(::seteuid(nobody), 0);
  }
  expect_refused(scratch / "a.vtu", "Permission denied",
                 [&] { write_vtu(scratch / "a.vtu", two_tets()); });
  if (root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
  std::filesystem::permissions(scratch.folder(), std::filesystem::perms::owner_all);
}

// A limit on the size of files stands for a full disk: writing fails in the middle.
TEST(Refused, AnOldFileSurvivesAFailedWrite) {
  const Scratch scratch;
  const std::string path = scratch / "a.vtu";
  write_vtu(path, two_tets());
  const std::string before = read_text(path);

  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  rlimit small = limit;
  small.rlim_cur = 1000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  expect_refused(path, "cannot be written: File too large", [&] { write_vtu(path, two_tets()); });
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::signal(SIGXFSZ, old_handler);

  EXPECT_EQ(read_text(path), before);
  EXPECT_EQ(scratch.file_count(), 1u);  // no temporary left
}

}  // namespace brainshift::io
