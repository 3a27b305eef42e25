// Numbers in messages, whatever the locale of the host.
#pragma once

#include <charconv>
#include <string>

namespace brainshift {

inline std::string text(double value) {
  char digits[32];
  return std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace brainshift
