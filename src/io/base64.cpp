#include "base64.hpp"

#include <cstdint>
#include <cstring>

namespace brainshift::io {

namespace {

constexpr char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// 0..63, or -1 for a character that does not belong to base64.
int digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  return -1;
}

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

}  // namespace

void append_base64(std::string& text, const void* bytes, std::size_t size) {
  const auto* in = static_cast<const unsigned char*>(bytes);
  text.reserve(text.size() + (size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t left = size - i;
    const std::uint32_t group = std::uint32_t(in[i]) << 16 |
                                (left > 1 ? std::uint32_t(in[i + 1]) << 8 : 0u) |
                                (left > 2 ? std::uint32_t(in[i + 2]) : 0u);
    text += alphabet[group >> 18];
    text += alphabet[group >> 12 & 63];
    text += left > 1 ? alphabet[group >> 6 & 63] : '=';
    text += left > 2 ? alphabet[group & 63] : '=';
  }
}

bool ByteSource::next_group() {
  std::uint32_t group = 0;
  int characters = 0, padding = 0;
  while (characters < 4) {
    if (m_position == m_text.size()) return false;
    const char c = m_text[m_position++];
    if (is_space(c)) continue;
    const int value = digit(c);
    if (c == '=' && characters >= 2) {
      ++padding;
    } else if (value < 0 || padding > 0) {
      return false;
    }
    group = group << 6 | std::uint32_t(value < 0 ? 0 : value);
    ++characters;
  }
  m_group[0] = static_cast<unsigned char>(group >> 16);
  m_group[1] = static_cast<unsigned char>(group >> 8);
  m_group[2] = static_cast<unsigned char>(group);
  m_group_size = std::size_t(3 - padding);
  m_group_used = 0;
  return true;
}

bool ByteSource::read(void* bytes, std::size_t size) {
  if (size > at_most()) return false;
  auto* out = static_cast<unsigned char*>(bytes);
  if (m_encoding == Encoding::raw) {
    if (size > 0) std::memcpy(out, m_text.data() + m_position, size);
    m_position += size;
    return true;
  }
  for (std::size_t i = 0; i < size; ++i) {
    if (m_group_used == m_group_size && !next_group()) return false;
    out[i] = m_group[m_group_used++];
  }
  return true;
}

std::size_t ByteSource::at_most() const {
  const std::size_t left = m_text.size() - m_position;
  return m_encoding == Encoding::raw ? left : m_group_size - m_group_used + left / 4 * 3;
}

}  // namespace brainshift::io
