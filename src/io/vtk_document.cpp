#include "vtk_document.hpp"

#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "brainshift/types.hpp"
#include "byte_order.hpp"
#include "file_error.hpp"

namespace brainshift::io {

namespace {

constexpr std::string_view blanks = " \t\r\n";

// The file must end in these tags: the XML in front of raw data is parsed without them, and a file
// cut short within the data would otherwise go unnoticed.
bool ends_with_tags(std::string_view text) {
  for (std::string_view tag :
       {std::string_view("</VTKFile>"), std::string_view("</AppendedData>")}) {
    const std::size_t last = text.find_last_not_of(blanks);
    if (last == std::string_view::npos || last + 1 < tag.size()) return false;
    text = text.substr(0, last + 1);
    if (text.substr(text.size() - tag.size()) != tag) return false;
    text = text.substr(0, text.size() - tag.size());
  }
  return true;
}

}  // namespace

bool parse_count(const char* text, std::size_t& value) {
  const char* end = text + std::strlen(text);
  const std::from_chars_result result = std::from_chars(text, end, value);
  return result.ec == std::errc() && result.ptr == end;
}

VtkDocument::VtkDocument(const std::string& path, const char* type) : m_path(path) {
  read_file();
  const std::size_t xml_size = split_appended();
  const pugi::xml_parse_result result =
      m_has_appended
          ? m_xml.load_string((m_text.substr(0, xml_size) + "</AppendedData></VTKFile>").c_str())
          : m_xml.load_buffer(m_text.data(), m_text.size());
  if (!result) {
    fail(m_path, "not whole XML: " + std::string(result.description()) + " at byte " +
                     std::to_string(result.offset) + "; is the file truncated?");
  }
  read_root(type);
}

void VtkDocument::read_file() {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(m_path, error);
  if (!std::filesystem::exists(status)) fail(m_path, "no such file");
  if (!std::filesystem::is_regular_file(status)) fail(m_path, "not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(m_path, error);
  std::ifstream file(m_path, std::ios::binary);
  if (error || !file) fail(m_path, "cannot be opened for reading");
  m_text.resize(std::size_t(size));
  file.read(m_text.data(), std::streamsize(size));
  if (std::uintmax_t(file.gcount()) != size) fail(m_path, "cannot be read to its end");
}

// Raw appended data are no XML; they are cut out before the parser sees them.
// Returns the size of the XML in front of them.
std::size_t VtkDocument::split_appended() {
  const std::size_t tag = m_text.find("<AppendedData");
  if (tag == std::string::npos) return m_text.size();
  const std::size_t close = m_text.find('>', tag);
  const std::size_t mark =
      close == std::string::npos ? close : m_text.find_first_not_of(blanks, close + 1);
  if (mark == std::string::npos || m_text[mark] != '_' || !ends_with_tags(m_text)) {
    fail(m_path,
         "the appended data do not begin with '_' or do not end with </AppendedData> and "
         "</VTKFile>; is the file truncated?");
  }
  const std::size_t end = m_text.rfind("</AppendedData>");
  m_appended = std::string_view(m_text).substr(mark + 1, end - mark - 1);
  m_has_appended = true;
  return close + 1;
}

void VtkDocument::read_root(const char* type) {
  const pugi::xml_node root = m_xml.child("VTKFile");
  if (!root) fail(m_path, "not a VTK XML file: it has no element VTKFile");
  const std::string found = root.attribute("type").value();
  if (found != type) fail(m_path, "holds a VTK '" + found + "', expected '" + type + "'");

  const std::string order = root.attribute("byte_order").value();
  if (order != "LittleEndian" && order != "BigEndian") {
    fail(m_path, "unknown byte_order '" + order + "'");
  }
  m_swapped = (order == "LittleEndian") != little_endian();

  const std::string header = root.attribute("header_type").as_string("UInt32");
  if (header != "UInt32" && header != "UInt64")
    fail(m_path, "unknown header_type '" + header + "'");
  m_header_size = header == "UInt64" ? 8 : 4;

  const std::string compressor = root.attribute("compressor").value();
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
    fail(m_path, "compressed by '" + compressor + "'; only vtkZLibDataCompressor is read");
  }
  m_compressed = !compressor.empty();

  if (m_has_appended) {
    const std::string encoding = root.child("AppendedData").attribute("encoding").value();
    if (encoding != "raw" && encoding != "base64") {
      fail(m_path, "unknown encoding '" + encoding + "' of the appended data");
    }
    m_appended_encoding =
        encoding == "raw" ? ByteSource::Encoding::raw : ByteSource::Encoding::base64;
  }

  const pugi::xml_node content = root.child(type);
  m_piece = content.child("Piece");
  if (!m_piece) fail(m_path, std::string("has no Piece in its ") + type);
  if (m_piece.next_sibling("Piece")) fail(m_path, "has more than one Piece; only one is read");
}

std::size_t VtkDocument::count(const char* attribute) const {
  if (!m_piece.attribute(attribute)) fail(m_path, std::string("its Piece lacks ") + attribute);
  return count(attribute, 0);
}

std::size_t VtkDocument::count(const char* attribute, std::size_t otherwise) const {
  const pugi::xml_attribute found = m_piece.attribute(attribute);
  if (!found) return otherwise;
  std::size_t value = 0;
  if (!parse_count(found.value(), value) ||
      value > std::size_t(std::numeric_limits<Index>::max())) {
    fail(m_path, std::string(attribute) + " is '" + found.value() +
                     "', expected a whole number from 0 to 2147483647");
  }
  return value;
}

ByteSource VtkDocument::inline_data(pugi::xml_node array) const {
  return ByteSource(array.child_value(), ByteSource::Encoding::base64);
}

ByteSource VtkDocument::appended_data(std::size_t offset, const std::string& name) const {
  if (!m_has_appended)
    fail(m_path, "array '" + name + "' is appended, but there is no AppendedData");
  if (offset > m_appended.size()) {
    fail(m_path, "array '" + name + "' begins at offset " + std::to_string(offset) +
                     " of appended data of " + std::to_string(m_appended.size()) + " bytes");
  }
  return ByteSource(m_appended.substr(offset), m_appended_encoding);
}

}  // namespace brainshift::io
