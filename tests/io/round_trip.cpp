#include <cstring>
#include <limits>
#include <locale>

#include "io_test.hpp"

namespace brainshift::io {

TEST(RoundTrip, TetsComeBackAsTheyWere) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", two_tets());
  expect_same(read_vtu(scratch / "a.vtu"), two_tets());
}

TEST(RoundTrip, TrianglesComeBackAsTheyWere) {
  const Scratch scratch;
  write_vtp(scratch / "a.vtp", three_triangles());
  expect_same(read_vtp(scratch / "a.vtp"), three_triangles());
}

TEST(RoundTrip, LinesComeBackAsTheyWereAloneAndBeforeTriangles) {
  const Scratch scratch;
  Grid grid = three_lines();
  write_vtp(scratch / "a.vtp", grid);
  expect_same(read_vtp(scratch / "a.vtp"), grid);
  grid.triangles = three_triangles().triangles;
  grid.cell_fields[0].values.resize(6, 1);
  grid.cell_fields[0].values << 1, 2, 3, 4, 5, 6;
  write_vtp(scratch / "a.vtp", grid);
  expect_same(read_vtp(scratch / "a.vtp"), grid);
}

TEST(RoundTrip, ExtremeNumbersKeepEveryBit) {
  const Scratch scratch;
  using Limits = std::numeric_limits<double>;
  Grid grid = two_tets();
  grid.node_fields = {{"extreme", Eigen::MatrixXd(5, 1), false}};
  grid.node_fields[0].values << Limits::max(), Limits::lowest(), Limits::denorm_min(), -0.0,
      1.0 + Limits::epsilon();
  grid.cell_fields = {{"limits", Eigen::MatrixXd(2, 1), true}};
  grid.cell_fields[0].values << std::numeric_limits<Index>::min(),
      std::numeric_limits<Index>::max();
  write_vtu(scratch / "a.vtu", grid);
  const Grid back = read_vtu(scratch / "a.vtu");
  expect_same(back, grid);
  EXPECT_EQ(std::memcmp(back.node_fields[0].values.data(), grid.node_fields[0].values.data(),
                        5 * sizeof(double)),
            0);
}

// 64 KiB are compressed together: 8192 values fill one block exactly, one more begins the next.
TEST(RoundTrip, ArraysOfSeveralBlocksComeBack) {
  const Scratch scratch;
  for (const int nodes : {8191, 8192, 8193, 20000}) {
    Grid grid;
    grid.points = Points::Random(nodes, 3);
    grid.node_fields = {{"noise", Eigen::MatrixXd::Random(nodes, 1), false},
                        {"constant", Eigen::MatrixXd::Constant(nodes, 2, 0.1), false}};
    write_vtu(scratch / "a.vtu", grid);
    expect_same(read_vtu(scratch / "a.vtu"), grid);
  }
}

TEST(RoundTrip, AnEmptyGridComesBack) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", Grid{});
  expect_same(read_vtu(scratch / "a.vtu"), Grid{});
  write_vtp(scratch / "a.vtp", Grid{});
  expect_same(read_vtp(scratch / "a.vtp"), Grid{});
}

TEST(RoundTrip, NamesMayHoldCharactersOfXml) {
  const Scratch scratch;
  Grid grid = two_tets();
  grid.node_fields[0].name = "a<b & \"c\" > 'd' \xC3\xA9";
  write_vtu(scratch / "a.vtu", grid);
  EXPECT_EQ(read_vtu(scratch / "a.vtu").node_field(grid.node_fields[0].name).values,
            grid.node_fields[0].values);
}

TEST(RoundTrip, TheSameGridGivesTheSameBytes) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", two_tets());
  write_vtu(scratch / "b.vtu", two_tets());
  EXPECT_EQ(read_text(scratch / "a.vtu"), read_text(scratch / "b.vtu"));
}

// A decimal comma, as a host with a German user interface sets it for the whole process.
struct CommaPoint : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(RoundTrip, TheLocaleOfTheHostDoesNotMatter) {
  const Scratch scratch;
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaPoint));
  const std::string c_before = std::setlocale(LC_ALL, nullptr);
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // where it is installed
  write_pvd(scratch / "a.pvd", {{1234.5, "stage.vtu"}});
  const std::string fixture = std::string(BRAINSHIFT_IO_TESTS) + "/fixtures/ascii_32.vtu";
  expect_same(read_vtu(fixture), two_tets());
  std::setlocale(LC_ALL, c_before.c_str());
  std::locale::global(before);
  EXPECT_NE(read_text(scratch / "a.pvd").find("timestep=\"1234.5\""), std::string::npos);
}

TEST(RoundTrip, ASeriesNamesItsFilesInOrder) {
  const Scratch scratch;
  write_pvd(scratch / "a.pvd", {{0.0, "stage_0.vtu"}, {9.0, "a & b.vtu"}});
  const std::string text = read_text(scratch / "a.pvd");
  const std::size_t first = text.find("timestep=\"0\" part=\"0\" file=\"stage_0.vtu\"");
  const std::size_t second = text.find("timestep=\"9\" part=\"0\" file=\"a &amp; b.vtu\"");
  ASSERT_NE(first, std::string::npos) << text;
  ASSERT_NE(second, std::string::npos) << text;
  EXPECT_LT(first, second);
}

TEST(RoundTrip, AFieldThatIsNotThereIsNamed) {
  try {
    two_tets().node_field("velocity");
    FAIL() << "velocity was found";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file);
    EXPECT_NE(std::string(error.what()).find("node array 'velocity'"), std::string::npos);
  }
  EXPECT_EQ(two_tets().cell_field("region").values(1, 0), 6.0);
}

}  // namespace brainshift::io
