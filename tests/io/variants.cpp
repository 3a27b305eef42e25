// Every way in which a DataArray may be stored, built byte by byte from the format's description.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include <zlib.h>

#include "io/base64.hpp"
#include "io_test.hpp"

namespace brainshift::io {

namespace {

struct Variant {
  bool zlib = false;
  bool wide_header = false;  // UInt64
  bool big_endian = false;
  bool appended = false, raw = false;
};

std::string bytes_of(const void* data, std::size_t size) {
  return std::string(static_cast<const char*>(data), size);
}

std::string ordered(std::string bytes, std::size_t size, const Variant& variant) {
  if (variant.big_endian) {  // the tests run on little-endian machines
    for (std::size_t i = 0; i < bytes.size(); i += size) {
      std::reverse(bytes.begin() + std::ptrdiff_t(i), bytes.begin() + std::ptrdiff_t(i + size));
    }
  }
  return bytes;
}

std::string header_of(std::vector<std::uint64_t> words, const Variant& variant) {
  std::string bytes;
  for (std::uint64_t word : words) {
    const std::uint32_t narrow = std::uint32_t(word);
    bytes += variant.wide_header ? ordered(bytes_of(&word, 8), 8, variant)
                                 : ordered(bytes_of(&narrow, 4), 4, variant);
  }
  return bytes;
}

std::string coded(const std::string& bytes, const Variant& variant) {
  if (variant.raw) return bytes;
  std::string text;
  append_base64(text, bytes.data(), bytes.size());
  return text;
}

std::string stored(const std::string& bytes, const Variant& variant) {
  if (!variant.zlib) return coded(header_of({bytes.size()}, variant) + bytes, variant);
  constexpr std::size_t block = 16;
  std::vector<std::uint64_t> header{(bytes.size() + block - 1) / block, block,
                                    bytes.size() % block};
  std::string packed;
  for (std::size_t i = 0; i < bytes.size(); i += block) {
    const std::string part = bytes.substr(i, block);
    std::vector<unsigned char> out(compressBound(uLong(part.size())));
    uLongf size = uLongf(out.size());
    compress(out.data(), &size, reinterpret_cast<const Bytef*>(part.data()), uLong(part.size()));
    header.push_back(size);
    packed += bytes_of(out.data(), size);
  }
  return coded(header_of(header, variant), variant) + coded(packed, variant);
}

// One tet with a node array of the type T.
template <class T>
std::string file_with(const char* type, const std::vector<T>& values, const Variant& variant) {
  std::string appended;
  const auto array = [&](const char* name, const char* array_type, int components,
                         std::string bytes, std::size_t size) {
    const std::string data = stored(ordered(std::move(bytes), size, variant), variant);
    std::string text = "<DataArray type=\"" + std::string(array_type) + "\" Name=\"" + name +
                       "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"";
    if (!variant.appended) return text + "binary\">\n  " + data + "\n</DataArray>";
    text += "appended\" offset=\"" + std::to_string(appended.size()) + "\"/>";
    appended += data;
    return text;
  };
  const std::vector<float> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<std::int16_t> connectivity{0, 1, 2, 3};
  const std::uint32_t offset = 4;
  const std::uint8_t tetra = 10;
  std::string text =
      std::string("<VTKFile type=\"UnstructuredGrid\" byte_order=\"") +
      (variant.big_endian ? "BigEndian" : "LittleEndian") + "\" header_type=\"" +
      (variant.wide_header ? "UInt64\"" : "UInt32\"") +
      (variant.zlib ? " compressor=\"vtkZLibDataCompressor\"" : "") +
      "><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><PointData>" +
      array("values", type, 1, bytes_of(values.data(), 4 * sizeof(T)), sizeof(T)) +
      "</PointData><Points>" + array("Points", "Float32", 3, bytes_of(points.data(), 48), 4) +
      "</Points><Cells>" + array("connectivity", "Int16", 1, bytes_of(connectivity.data(), 8), 2) +
      array("offsets", "UInt32", 1, bytes_of(&offset, 4), 4) +
      array("types", "UInt8", 1, bytes_of(&tetra, 1), 1) + "</Cells></Piece></UnstructuredGrid>";
  if (variant.appended) {
    text += std::string("<AppendedData encoding=\"") + (variant.raw ? "raw" : "base64") +
            "\">\n _" + appended + "\n</AppendedData>";
  }
  return text + "</VTKFile>\n";
}

std::vector<Variant> all_variants() {
  std::vector<Variant> variants;
  for (int bits = 0; bits < 32; ++bits) {
    Variant variant{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0,
                    (bits & 16) != 0};
    if (variant.appended || !variant.raw) variants.push_back(variant);
  }
  return variants;
}

template <class T>
void check_type(const char* type, const std::vector<T>& values) {
  const Scratch scratch;
  for (const Variant& variant : all_variants()) {
    const std::string path = scratch / "a.vtu";
    write_text(path, file_with(type, values, variant));
    const Grid grid = read_vtu(path);
    EXPECT_EQ(grid.points(3, 2), 1.0);
    EXPECT_EQ(grid.tets(0, 3), 3);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(grid.node_field("values").values(i, 0), double(values[std::size_t(i)]))
          << type << (variant.zlib ? " zlib" : "") << (variant.big_endian ? " big-endian" : "");
    }
  }
}

}  // namespace

TEST(Variants, Float32) { check_type<float>("Float32", {0.1f, -3e38f, 1e-42f, 7.0f}); }
TEST(Variants, Float64) { check_type<double>("Float64", {0.1, -1e308, 5e-324, 7.0}); }
TEST(Variants, Int8) { check_type<std::int8_t>("Int8", {-128, 127, 0, 1}); }
TEST(Variants, UInt8) { check_type<std::uint8_t>("UInt8", {0, 255, 1, 2}); }
TEST(Variants, Int16) { check_type<std::int16_t>("Int16", {-32768, 32767, 0, 1}); }
TEST(Variants, UInt16) { check_type<std::uint16_t>("UInt16", {0, 65535, 1, 2}); }
TEST(Variants, Int32) { check_type<std::int32_t>("Int32", {INT32_MIN, INT32_MAX, 0, 1}); }
TEST(Variants, UInt32) { check_type<std::uint32_t>("UInt32", {0, UINT32_MAX, 1, 2}); }
TEST(Variants, Int64) { check_type<std::int64_t>("Int64", {-(1LL << 53), 1LL << 53, 0, 1}); }
TEST(Variants, UInt64) { check_type<std::uint64_t>("UInt64", {0, 1ULL << 53, 1, 2}); }

// Raw data may hold anything, also what looks like XML or ends a C string.
TEST(Variants, RawBytesMayLookLikeTags) {
  std::vector<std::uint64_t> values(4, 0);
  std::memcpy(values.data(), "</AppendedData>\0</VTKFile><Piece>", 32);
  const Scratch scratch;
  write_text(scratch / "a.vtu",
             file_with("UInt64", values, Variant{false, true, false, true, true}));
  EXPECT_EQ(read_vtu(scratch / "a.vtu").node_field("values").values(0, 0), double(values[0]));
}

namespace {

// One file for each way of storing; byte order and width of the header change nothing below.
std::vector<std::string> small_files() {
  std::vector<std::string> files{
      read_text(std::string(BRAINSHIFT_IO_TESTS) + "/fixtures/ascii_32.vtu")};
  for (const Variant& variant : all_variants()) {
    if (!variant.wide_header || variant.big_endian) continue;
    files.push_back(file_with<double>("Float64", {1, 2, 3, 4}, variant));
  }
  return files;
}

}  // namespace

// Any prefix ends in an error, except one that lacks only the last line break.
TEST(Variants, EveryPrefixOfAFileIsRefused) {
  const Scratch scratch;
  const std::string path = scratch / "a.vtu";
  for (const std::string& whole : small_files()) {
    ASSERT_EQ(whole.back(), '\n');
    for (std::size_t size = 0; size + 1 < whole.size(); ++size) {
      write_text(path, whole.substr(0, size));
      expect_refused(path, "", [&] { read_vtu(path); });
      if (::testing::Test::HasFailure()) FAIL() << "prefix of " << size << " bytes";
    }
  }
}

// No damage may crash the reader (the sanitizers watch): it reads what is left, or refuses.
TEST(Variants, AnyByteChangedIsReadOrRefused) {
  const Scratch scratch;
  const std::string path = scratch / "a.vtu";
  std::uint32_t random = 1;
  for (const std::string& whole : small_files()) {
    for (std::size_t i = 0; i < whole.size(); ++i) {
      std::string damaged = whole;
      random = random * 1664525u + 1013904223u;
      damaged[i] = char(random >> 24);
      write_text(path, damaged);
      try {
        read_vtu(path);
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::file) << error.what();
      }
    }
  }
}

}  // namespace brainshift::io
