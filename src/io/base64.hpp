// Base64 (RFC 4648, section 4) as VTK uses it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace brainshift::io {

// Appends the encoding of `size` bytes, padded.
void append_base64(std::string& text, const void* bytes, std::size_t size);

// Reads bytes one after the other, from raw data or from base64 text.
//
// VTK encodes the header of a compressed array on its own and other writers do so for every array,
// so padding may stand in the middle: each group of four characters is decoded by itself.
class ByteSource {
 public:
  enum class Encoding { raw, base64 };
  ByteSource(std::string_view text, Encoding encoding) : m_text(text), m_encoding(encoding) {}

  // False, with nothing promised about `bytes`, where the data ends early or is not base64.
  bool read(void* bytes, std::size_t size);
  // No more bytes than this can come; asked before memory is taken for them.
  std::size_t at_most() const;

 private:
  bool next_group();

  std::string_view m_text;
  Encoding m_encoding;
  std::size_t m_position = 0;
  unsigned char m_group[3] = {};
  std::size_t m_group_size = 0;
  std::size_t m_group_used = 0;
};

}  // namespace brainshift::io
