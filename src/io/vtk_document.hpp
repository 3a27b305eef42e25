// A VTK XML file in memory: its XML, its appended data, and what its root promises.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <pugixml.hpp>

#include "base64.hpp"

namespace brainshift::io {

class VtkDocument {
 public:
  // type: "UnstructuredGrid" or "PolyData". Throws Error(file).
  VtkDocument(const std::string& path, const char* type);
  VtkDocument(const VtkDocument&) = delete;
  VtkDocument& operator=(const VtkDocument&) = delete;

  const std::string& path() const { return m_path; }
  pugi::xml_node piece() const { return m_piece; }  // the only one of the file
  // A count such as NumberOfPoints; an absent one is refused unless `otherwise` is given.
  std::size_t count(const char* attribute) const;
  std::size_t count(const char* attribute, std::size_t otherwise) const;

  bool swapped() const { return m_swapped; }                 // bytes in the other order than ours
  bool compressed() const { return m_compressed; }           // zlib
  std::size_t header_size() const { return m_header_size; }  // bytes: 4 or 8

  // Where the binary data of a DataArray begin.
  ByteSource inline_data(pugi::xml_node array) const;
  ByteSource appended_data(std::size_t offset, const std::string& name) const;

 private:
  void read_file();
  std::size_t split_appended();
  void read_root(const char* type);

  std::string m_path;
  std::string m_text;
  std::string_view m_appended;
  ByteSource::Encoding m_appended_encoding = ByteSource::Encoding::raw;
  bool m_has_appended = false;
  pugi::xml_document m_xml;
  pugi::xml_node m_piece;
  bool m_swapped = false;
  bool m_compressed = false;
  std::size_t m_header_size = 4;
};

// A whole number without sign, nothing before or after it; false otherwise.
bool parse_count(const char* text, std::size_t& value);

}  // namespace brainshift::io
