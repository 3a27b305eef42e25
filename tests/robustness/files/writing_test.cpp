// Writers: every digit, whole files or none, and paths of every kind.
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdio>
#include <random>

#include "io/io_test.hpp"

namespace brainshift::io {
namespace {

Grid noisy_grid() {
  Grid grid = two_tets();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  for (Eigen::Index i = 0; i < grid.node_fields[0].values.size(); ++i) {
    const int exponent = int(random() % 600) - 300;
    grid.node_fields[0].values.data()[i] = std::ldexp(mantissa(random), exponent);
  }
  grid.points(4, 2) =
      9.9999999999999978e-05;  // cut to 20 characters elsewhere, and unreadable there
  return grid;
}

TEST(Files, O5_every_digit_is_kept) {
  const Scratch scratch;
  const Grid grid = noisy_grid();
  write_vtu(scratch / "a.vtu", grid);
  expect_same(read_vtu(scratch / "a.vtu"), grid);
}

TEST(Files, O7_saving_what_was_loaded_gives_the_same_bytes) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", noisy_grid());
  write_vtu(scratch / "b.vtu", read_vtu(scratch / "a.vtu"));
  EXPECT_EQ(read_text(scratch / "a.vtu"), read_text(scratch / "b.vtu"));
}

// Writing fails after n bytes, for every n up to the size of the file: the old one stays.
TEST(Files, O6_an_old_file_survives_a_disk_that_fills_up_at_any_byte) {
  const Scratch scratch;
  const std::string path = scratch / "a.vtu";
  write_vtu(path, two_tets());
  const std::string before = read_text(path);
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  for (rlim_t most = 0; most < before.size(); most += 97) {
    rlimit small = limit;
    small.rlim_cur = most;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    std::string message;
    try {
      write_vtu(path, noisy_grid());
    } catch (const Error& error) {
      message = error.what();
    }
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    EXPECT_NE(message.find("cannot be written"), std::string::npos) << most;
    EXPECT_EQ(read_text(path), before) << most;
    EXPECT_EQ(scratch.file_count(), 1u) << most;
  }
  std::signal(SIGXFSZ, old_handler);
}

TEST(Files, O6_a_full_disk) {
  const Scratch scratch;
  const std::string folder = scratch / "disk";
  std::filesystem::create_directory(folder);
  if (mount("none", folder.c_str(), "tmpfs", 0, "size=16k") != 0) {
    GTEST_SKIP() << "mounting a small disk is not permitted";
  }
  const std::string path = folder + "/a.vtu";
  write_vtu(path, two_tets());
  const std::string before = read_text(path);
  std::string filler(1 << 15, 'x'), message;
  write_text(folder + "/filler", filler);  // as far as it goes
  try {
    for (int i = 0; i < 4; ++i) write_vtu(folder + "/b" + std::to_string(i) + ".vtu", two_tets());
  } catch (const Error& error) {
    message = error.what();
  }
  const std::string after = read_text(path);
  const bool temporary = std::filesystem::exists(folder + "/b0.vtu.0.tmp");
  umount(folder.c_str());
  EXPECT_NE(message.find("No space left"), std::string::npos) << message;
  EXPECT_EQ(after, before);
  EXPECT_FALSE(temporary);
}

TEST(Files, O9_paths_of_every_kind) {
  const Scratch scratch;
  for (const std::string name :
       {"with a space.vtu", "\xC3\xA4\xE2\x82\xAC.vtu", "a'b\"c&<d>.vtu"}) {
    write_vtu(scratch / name, two_tets());
    expect_same(read_vtu(scratch / name), two_tets());
  }
  const std::string endless = scratch / (std::string(5000, 'a') + ".vtu");
  EXPECT_THROW(write_vtu(endless, two_tets()), Error);
  EXPECT_THROW(read_vtu(endless), Error);
  const std::string pipe = scratch / "pipe.vtu";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expect_refused(pipe, "not a regular file", [&] { read_vtu(pipe); });
  expect_refused(pipe, "not a regular file", [&] { write_vtu(pipe, two_tets()); });
  expect_refused("/dev/full", "not a regular file", [&] { write_vtu("/dev/full", two_tets()); });
  EXPECT_THROW(read_vtu(""), Error);
  EXPECT_THROW(write_vtu("", two_tets()), Error);
}

// A link that dangles, or leads to a file elsewhere.
TEST(Files, O9_links) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", two_tets());
  std::filesystem::create_symlink("a.vtu", scratch / "link.vtu");
  expect_same(read_vtu(scratch / "link.vtu"), two_tets());
  std::filesystem::create_symlink("nowhere.vtu", scratch / "dangling.vtu");
  EXPECT_THROW(read_vtu(scratch / "dangling.vtu"), Error);
}

}  // namespace
}  // namespace brainshift::io
