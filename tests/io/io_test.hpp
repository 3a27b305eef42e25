// Shared by the tests of this folder: a small grid, scratch files, and what an error must look like.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "brainshift/error.hpp"
#include "brainshift/io.hpp"

namespace brainshift::io {

// A folder of its own for each test, gone at the end.
class Scratch {
 public:
  Scratch() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    m_folder = std::filesystem::temp_directory_path() /
               ("brainshift_io_" + std::string(test->test_suite_name()) + "_" + test->name() + "_" +
                std::to_string(::getpid()));
    std::filesystem::remove_all(m_folder);
    std::filesystem::create_directories(m_folder);
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(m_folder, ignored);
  }
  std::string operator/(const std::string& name) const { return (m_folder / name).string(); }
  const std::filesystem::path& folder() const { return m_folder; }
  std::size_t file_count() const {
    const std::filesystem::directory_iterator begin(m_folder);
    return std::size_t(std::distance(begin, std::filesystem::directory_iterator()));
  }

 private:
  std::filesystem::path m_folder;
};

inline std::string read_text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// The call throws Error(file) in one sentence that begins with the path and holds `words`.
template <class Call>
void expect_refused(const std::string& path, const std::string& words, Call call) {
  try {
    call();
    ADD_FAILURE() << path << " was accepted; expected: " << words;
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.code(), ErrorCode::file) << message;
    EXPECT_EQ(message.rfind(path + ": ", 0), 0u) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message << "\nexpected: " << words;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

// Two tets on five nodes, with the fields of tests/io/fixtures.
inline Grid two_tets() {
  Grid grid;
  grid.points.resize(5, 3);
  grid.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1.0 / 3.0, 1, 1e-3;
  grid.tets.resize(2, 4);
  grid.tets << 0, 1, 2, 3, 1, 4, 2, 3;
  Field displacement{"displacement", Eigen::MatrixXd(5, 3), false};
  Field pressure{"pressure", Eigen::MatrixXd(5, 1), false};
  Field wetted{"wetted", Eigen::MatrixXd(5, 1), true};
  for (int i = 0; i < 5; ++i) {
    displacement.values.row(i) << 0.1 * i, -i, 1e-9 * i;
    pressure.values(i, 0) = double(float(0.1 * i));  // the fixtures hold it as Float32
    wetted.values(i, 0) = i % 2 - 1;
  }
  Field region{"region", Eigen::MatrixXd(2, 1), true};
  region.values << 7, 6;
  grid.node_fields = {displacement, pressure, wetted};
  grid.cell_fields = {region};
  return grid;
}

// Its boundary at node 0, as triangles.
inline Grid three_triangles() {
  Grid grid = two_tets();
  grid.tets.resize(0, 4);
  grid.triangles.resize(3, 3);
  grid.triangles << 0, 2, 1, 0, 1, 3, 0, 3, 2;
  grid.cell_fields[0].values.resize(3, 1);
  grid.cell_fields[0].values << 7, 6, 5;
  return grid;
}

inline Grid three_lines() {
  Grid grid = three_triangles();
  grid.triangles.resize(0, 3);
  grid.lines.resize(3, 2);
  grid.lines << 0, 2, 2, 1, 3, 4;
  return grid;
}

// Bit for bit, up to the sign of zero.
inline void expect_same(const std::vector<Field>& a, const std::vector<Field>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].integer, b[i].integer) << a[i].name;
    EXPECT_EQ(a[i].values.cols(), b[i].values.cols()) << a[i].name;
    EXPECT_EQ(a[i].values, b[i].values) << a[i].name;
  }
}

inline void expect_same(const Grid& a, const Grid& b) {
  ASSERT_EQ(a.points.rows(), b.points.rows());
  ASSERT_EQ(a.tets.rows(), b.tets.rows());
  ASSERT_EQ(a.triangles.rows(), b.triangles.rows());
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.lines.rows(), b.lines.rows());
  EXPECT_EQ(a.lines, b.lines);
  expect_same(a.node_fields, b.node_fields);
  expect_same(a.cell_fields, b.cell_fields);
}

}  // namespace brainshift::io
