// Files cut short, with counts that lie, with numbers that are none: refused in one sentence, and
// without more memory than the file is worth.
#include <sys/resource.h>

#include <cmath>
#include <iterator>

#include "io/io_test.hpp"
#include "robustness/files/memory_file.hpp"

namespace brainshift::io {
namespace {

const std::string fixtures = std::string(BRAINSHIFT_IO_TESTS) + "/fixtures";

// name: of the fixture the content stems from.
Grid read(const MemoryFile& file, const std::string& name) {
  return name.back() == 'u' ? read_vtu(file.path()) : read_vtp(file.path());
}

std::string replaced(std::string text, const std::string& old_text, const std::string& new_text) {
  const std::size_t at = text.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  return text.replace(at, old_text.size(), new_text);
}

// Every prefix is refused, but for the line ends behind the last tag.
TEST(Files, O1_truncated_at_every_byte) {
  const MemoryFile file;
  int files = 0, refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(fixtures)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".vtu" && extension != ".vtp") continue;
    ++files;
    const std::string text = read_text(entry.path().string());
    const std::size_t whole = text.find_last_not_of(" \t\r\n") + 1;
    for (std::size_t size = 0; size < whole; ++size) {
      ASSERT_TRUE(file.write(text.data(), size));
      try {
        read(file, extension);
        ADD_FAILURE() << entry.path() << " read from its first " << size << " bytes of " << whole;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::file) << error.what();
        ++refused;
      }
    }
    ASSERT_TRUE(file.write(text.data(), whole));
    EXPECT_NO_THROW(read(file, extension)) << entry.path();
  }
  EXPECT_EQ(files, 15);
  EXPECT_GT(refused, 15000);
}

// One byte of a file flipped: read as something finite, or refused; nothing else may happen.
TEST(Files, O1_one_byte_wrong_at_every_place) {
  const MemoryFile file;
  for (const char* name : {"ascii_32.vtu", "inline_zlib_32.vtu", "base64_zlib_32.vtp"}) {
    const std::string text = read_text(fixtures + "/" + name);
    int read_all_the_same = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      std::string wrong = text;
      wrong[i] = char(wrong[i] ^ (1 << (i % 7)));
      ASSERT_TRUE(file.write(wrong));
      try {
        const Grid grid = read(file, name);
        EXPECT_TRUE(grid.points.allFinite());
        ++read_all_the_same;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::file) << error.what();
      }
    }
    EXPECT_LT(std::size_t(read_all_the_same), text.size() / 2) << name;
  }
}

// The address space is limited while a header promises what no file of this size can hold.
TEST(Files, O2_counts_that_lie_cost_no_memory) {
  const Scratch scratch;
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &limit), 0);
  const std::string text = read_text(fixtures + "/ascii_32.vtu");
  std::vector<std::string> lies;
  for (const char* count : {"2147483647", "2147483648", "1000000000000", "18446744073709551615",
                            "18446744073709551616", "-1", "5.0", "", "0x5", "6", "4", "0"}) {
    const std::string number = count;
    lies.push_back(replaced(text, "NumberOfPoints=\"5\"", "NumberOfPoints=\"" + number + "\""));
    lies.push_back(replaced(text, "NumberOfCells=\"2\"", "NumberOfCells=\"" + number + "\""));
    lies.push_back(
        replaced(text, "NumberOfComponents=\"3\"", "NumberOfComponents=\"" + number + "1\""));
  }
  for (const std::string& lie : lies) {
    write_text(scratch / "lie.vtu", lie);
    rlimit small = limit;
    small.rlim_cur = 2000000000;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    ASSERT_EQ(setrlimit(RLIMIT_AS, &small), 0);
#endif
    EXPECT_THROW(read_vtu(scratch / "lie.vtu"), Error) << lie;
    ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
  }
}

TEST(Files, O3_line_ends_marks_tabs_and_comments) {
  const Scratch scratch;
  const Grid plain = read_vtu(fixtures + "/ascii_32.vtu");
  const std::string text = read_text(fixtures + "/ascii_32.vtu");
  std::string crlf, tabs = text;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (char& c : tabs) c = c == '\n' ? '\t' : c;
  const std::string commented = replaced(text, "<Points>", "<!-- a comment -->\n\n<Points>");
  for (const std::string& variant : {crlf, tabs, "\xEF\xBB\xBF" + text, commented}) {
    write_text(scratch / "a.vtu", variant);
    expect_same(read_vtu(scratch / "a.vtu"), plain);
  }
}

TEST(Files, O4_numbers_that_are_none) {
  const Scratch scratch;
  const std::string text = read_text(fixtures + "/ascii_32.vtu");
  const auto with = [&](const std::string& number) {
    write_text(scratch / "a.vtu", replaced(text, "0 0 0 0.1", "0 0 " + number + " 0.1"));
    return read_vtu(scratch / "a.vtu").node_field("displacement").values(0, 2);
  };
  for (const char* bad : {"nan", "-nan", "NaN", "inf", "-Infinity", "1e999", "-1e999", "0x1p3",
                          "1,5", "1.5f", "--1", "1e", ".", "e5", "1.2.3", "\xC2\xBD"})
    EXPECT_THROW(with(bad), Error) << bad;
  std::string digits = "0.";
  for (int i = 0; i < 400; ++i) digits += "1234567890"[i % 10];
  EXPECT_EQ(with(digits), 0.1234567890123456789);
  EXPECT_THROW(with("1e-400"), Error);  // out of the range of double, below as above
  EXPECT_EQ(with("4e-310"), 4e-310);
  EXPECT_EQ(with("9007199254740993"), 9007199254740992.0);  // round to even
  EXPECT_EQ(with("-0"), 0.0);
}

TEST(Files, O10_other_cells_among_the_tets) {
  const Scratch scratch;
  const std::string text = read_text(fixtures + "/ascii_32.vtu");
  for (const char* type : {"12", "24", "13", "5", "0", "255"}) {  // 24: quadratic tet
    write_text(scratch / "a.vtu", replaced(text, "10 10\n", std::string("10 ") + type + "\n"));
    expect_refused(scratch / "a.vtu", "cell 1 is of VTK type",
                   [&] { read_vtu(scratch / "a.vtu"); });
  }
}

}  // namespace
}  // namespace brainshift::io
