// The number types of VTK's DataArray, each turned into a double.
#pragma once

#include <cstddef>

namespace brainshift::io {

struct ScalarType {
  const char* name;
  std::size_t size;  // bytes
  bool integer;
  double (*from_bytes)(const unsigned char* bytes);  // in the byte order of this machine
  // Parses the number at [begin, end), whatever the locale; returns where it stopped, or nullptr
  // where there is no number of this type.
  const char* (*from_text)(const char* begin, const char* end, double& value);
};

// nullptr for a name that is not known.
const ScalarType* scalar_type(const char* name);

}  // namespace brainshift::io
