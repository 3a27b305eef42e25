#include "scalar_type.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace brainshift::io {

namespace {

template <class T>
double from_bytes(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

// A Float32 is parsed as one, so that the ascii and the binary form of a file give the same bits.
template <class T>
const char* from_text(const char* begin, const char* end, double& value) {
  if (begin != end && *begin == '+') ++begin;
  T parsed{};
  const std::from_chars_result result = std::from_chars(begin, end, parsed);
  if (result.ec != std::errc()) return nullptr;
  value = static_cast<double>(parsed);
  return result.ptr;
}

template <class T>
constexpr ScalarType describe(const char* name) {
  return {name, sizeof(T), std::is_integral_v<T>, from_bytes<T>, from_text<T>};
}

constexpr ScalarType types[] = {
    describe<float>("Float32"),      describe<double>("Float64"),
    describe<std::int8_t>("Int8"),   describe<std::uint8_t>("UInt8"),
    describe<std::int16_t>("Int16"), describe<std::uint16_t>("UInt16"),
    describe<std::int32_t>("Int32"), describe<std::uint32_t>("UInt32"),
    describe<std::int64_t>("Int64"), describe<std::uint64_t>("UInt64"),
};

}  // namespace

const ScalarType* scalar_type(const char* name) {
  for (const ScalarType& type : types) {
    if (std::strcmp(type.name, name) == 0) return &type;
  }
  return nullptr;
}

}  // namespace brainshift::io
