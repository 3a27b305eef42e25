// Numbers in messages, whatever the locale of the host.
#pragma once

#include <charconv>
#include <string>

namespace brainshift {

inline std::string text(double value) {
  char digits[32];
  return std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

// With `precision` significant digits at most, as %.*g does.
inline std::string text(double value, int precision) {
  char digits[64];
  const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general,
                                 precision);
  return std::string(digits, end.ptr);
}

}  // namespace brainshift
