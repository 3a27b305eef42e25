#include "vtk_array.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <zlib.h>

#include "byte_order.hpp"
#include "file_error.hpp"
#include "scalar_type.hpp"

namespace brainshift::io {

namespace {

using Bytes = std::vector<unsigned char>;

// Deflate shrinks by no more than about 1030 to 1: a header that promises more is wrong.
constexpr std::size_t largest_compression = 1040;
constexpr std::size_t most_components = 4096;

class ArrayReader {
 public:
  ArrayReader(const VtkDocument& document, pugi::xml_node array, std::size_t rows,
              std::size_t components);
  Field read();

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    fail(m_document.path(), "array '" + m_name + "' " + what);
  }
  void read_ascii(const char* text);
  void read_binary(ByteSource source);
  Bytes read_plain(ByteSource& source) const;
  Bytes read_compressed(ByteSource& source) const;
  std::uint64_t header_word(ByteSource& source) const;
  std::uint64_t expected_bytes() const {
    return std::uint64_t(m_rows) * m_components * m_type->size;
  }
  void check_size(std::uint64_t bytes) const;
  void allocate() { m_field.values.resize(Eigen::Index(m_rows), Eigen::Index(m_components)); }
  void put(std::size_t i, double value);

  const VtkDocument& m_document;
  pugi::xml_node m_array;
  std::string m_name;
  const ScalarType* m_type;
  std::size_t m_rows, m_components = 1;
  Field m_field;
};

ArrayReader::ArrayReader(const VtkDocument& document, pugi::xml_node array, std::size_t rows,
                         std::size_t components)
    : m_document(document), m_array(array), m_name(array.attribute("Name").value()), m_rows(rows) {
  const char* type = array.attribute("type").value();
  m_type = scalar_type(type);
  if (!m_type) refuse(std::string("is of the unknown type '") + type + "'");
  const pugi::xml_attribute said = array.attribute("NumberOfComponents");
  if (said && (!parse_count(said.value(), m_components) || m_components == 0 ||
               m_components > most_components)) {
    refuse(std::string("has '") + said.value() + "' components");
  }
  if (components != 0 && m_components != components) {
    refuse("has " + std::to_string(m_components) + " components, expected " +
           std::to_string(components));
  }
  m_field.name = m_name;
  m_field.integer = m_type->integer;
}

Field ArrayReader::read() {
  const std::string format = m_array.attribute("format").as_string("ascii");
  if (format == "ascii") {
    read_ascii(m_array.child_value());
  } else if (format == "binary") {
    read_binary(m_document.inline_data(m_array));
  } else if (format == "appended") {
    std::size_t offset = 0;
    if (!parse_count(m_array.attribute("offset").value(), offset)) refuse("has no valid offset");
    read_binary(m_document.appended_data(offset, m_name));
  } else {
    refuse("is in the unknown format '" + format + "'");
  }
  return std::move(m_field);
}

void ArrayReader::put(std::size_t i, double value) {
  const std::size_t row = i / m_components;
  if (!std::isfinite(value)) refuse("holds NaN or infinity in row " + std::to_string(row));
  m_field.values(Eigen::Index(row), Eigen::Index(i % m_components)) = value;
}

void ArrayReader::read_ascii(const char* text) {
  const char* end = text + std::strlen(text);
  const std::size_t wanted = m_rows * m_components;
  const std::string expected = ", expected " + std::to_string(wanted);
  // A number takes a digit and a blank.
  const std::size_t at_most = (std::size_t(end - text) + 1) / 2;
  if (wanted > at_most) refuse("has room for " + std::to_string(at_most) + " values" + expected);
  allocate();
  const auto skip_blanks = [](const char* at) { return at + std::strspn(at, " \t\r\n"); };
  const char* at = skip_blanks(text);
  for (std::size_t i = 0; i < wanted; ++i) {
    if (at == end) refuse("holds " + std::to_string(i) + " values" + expected);
    double value = 0.0;
    const char* next = m_type->from_text(at, end, value);
    if (!next || (next != end && skip_blanks(next) == next)) {
      refuse("holds '" + std::string(at, std::strcspn(at, " \t\r\n")).substr(0, 40) +
             "', which is no " + m_type->name + ", as value " + std::to_string(i));
    }
    put(i, value);
    at = skip_blanks(next);
  }
  if (at != end) refuse("holds more values than the " + std::to_string(wanted) + " expected");
}

void ArrayReader::read_binary(ByteSource source) {
  Bytes bytes = m_document.compressed() ? read_compressed(source) : read_plain(source);
  const std::size_t count = m_rows * m_components;
  if (m_document.swapped()) swap_bytes(bytes.data(), count, m_type->size);
  allocate();
  for (std::size_t i = 0; i < count; ++i)
    put(i, m_type->from_bytes(bytes.data() + i * m_type->size));
}

std::uint64_t ArrayReader::header_word(ByteSource& source) const {
  unsigned char bytes[8] = {};
  const std::size_t size = m_document.header_size();
  if (!source.read(bytes, size)) refuse("is truncated in its header");
  if (m_document.swapped()) swap_bytes(bytes, 1, size);
  std::uint32_t narrow;
  std::uint64_t wide;
  std::memcpy(&narrow, bytes, 4);
  std::memcpy(&wide, bytes, 8);
  return size == 4 ? narrow : wide;
}

void ArrayReader::check_size(std::uint64_t bytes) const {
  if (bytes != expected_bytes()) {
    refuse("holds " + std::to_string(bytes) + " bytes, expected " +
           std::to_string(expected_bytes()) + " for " + std::to_string(m_rows) + " rows");
  }
}

Bytes ArrayReader::read_plain(ByteSource& source) const {
  // VTK leaves out the header of an empty inline array.
  if (m_rows == 0 && source.at_most() == 0) return {};
  const std::uint64_t size = header_word(source);
  check_size(size);
  if (size > source.at_most()) {
    refuse("is truncated: " + std::to_string(size) + " bytes said, at most " +
           std::to_string(source.at_most()) + " there");
  }
  Bytes bytes(size);
  if (!source.read(bytes.data(), size)) refuse("is truncated or not base64");
  return bytes;
}

// Header: number of blocks, size of a block, size of the last one if it is partial (else 0), and
// the compressed size of each block.
Bytes ArrayReader::read_compressed(ByteSource& source) const {
  if (m_rows == 0 && source.at_most() == 0) return {};
  const std::uint64_t blocks = header_word(source);
  if (blocks == 0 && m_rows == 0) return {};  // VTK may leave out the rest
  const std::uint64_t block_size = header_word(source), last_size = header_word(source);
  const std::uint64_t expected = expected_bytes();
  const std::uint64_t full_blocks = blocks - (last_size > 0 && blocks > 0 ? 1 : 0);
  if (blocks > source.at_most() / m_document.header_size() || last_size > block_size ||
      (full_blocks > 0 && block_size > expected / full_blocks)) {
    refuse("has a compression header that does not fit the file");
  }
  check_size(full_blocks * block_size + (blocks > full_blocks ? last_size : 0));

  std::vector<std::uint64_t> packed_sizes(blocks);
  for (std::uint64_t& size : packed_sizes) size = header_word(source);
  if (expected / largest_compression > source.at_most()) {
    refuse("promises " + std::to_string(expected) + " bytes out of at most " +
           std::to_string(source.at_most()));
  }

  Bytes bytes(expected), packed;
  unsigned char* out = bytes.data();
  for (std::uint64_t block = 0; block < blocks; ++block) {
    const std::uint64_t size = block < full_blocks ? block_size : last_size;
    if (packed_sizes[block] > source.at_most()) refuse("is truncated in its compressed blocks");
    packed.resize(packed_sizes[block]);
    if (!source.read(packed.data(), packed.size())) refuse("is truncated or not base64");
    uLongf written = uLongf(size);
    if (uncompress(out, &written, packed.data(), uLong(packed.size())) != Z_OK || written != size) {
      refuse("has a damaged compressed block " + std::to_string(block));
    }
    out += size;
  }
  return bytes;
}

}  // namespace

Field read_array(const VtkDocument& document, pugi::xml_node array, std::size_t rows,
                 std::size_t components) {
  return ArrayReader(document, array, rows, components).read();
}

}  // namespace brainshift::io
