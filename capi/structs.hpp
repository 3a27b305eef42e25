// Structs that grow at their end: struct_size tells which of them the caller's header knew.
#pragma once

#include <cstring>
#include <string>

#include "guard.hpp"

namespace brainshift::capi {

// Size of each struct when it first appeared; smaller ones were never made. Never change a number.
template <class T>
constexpr std::int64_t first_size = -1;
template <>
inline constexpr std::int64_t first_size<brs_surface_options> = 24;
template <>
inline constexpr std::int64_t first_size<brs_material> = 40;
template <>
inline constexpr std::int64_t first_size<brs_compartment> = 80;
template <>
inline constexpr std::int64_t first_size<brs_stepper_options> = 56;
template <>
inline constexpr std::int64_t first_size<brs_solve_report> = 144;
template <>
inline constexpr std::int64_t first_size<brs_compartment_state> = 56;
template <>
inline constexpr std::int64_t first_size<brs_contact_state> = 48;
template <>
inline constexpr std::int64_t first_size<brs_mesh_info> = 88;
template <>
inline constexpr std::int64_t first_size<brs_device_options> = 32;
template <>
inline constexpr std::int64_t first_size<brs_device_entry> = 88;
template <>
inline constexpr std::int64_t first_size<brs_device_info> = 64;
template <>
inline constexpr std::int64_t first_size<brs_hold> = 40;
template <>
inline constexpr std::int64_t first_size<brs_track_options> = 32;
template <>
inline constexpr std::int64_t first_size<brs_device_state> = 168;
template <>
inline constexpr std::int64_t first_size<brs_memory_estimate> = 48;
template <>
inline constexpr std::int64_t first_size<brs_mcp_options> = 56;
template <>
inline constexpr std::int64_t first_size<brs_mcp_report> = 56;

template <class T>
bool known_size(std::int64_t size) noexcept {
  static_assert(first_size<T> > 0 && std::int64_t(sizeof(T)) >= first_size<T>);
  return size >= first_size<T> && size <= std::int64_t(sizeof(T)) && size % 8 == 0;
}

template <class T>
std::int64_t checked_size(const T* given, const char* what) {
  const std::int64_t size = result(given, what).struct_size;
  if (!known_size<T>(size))
    throw Refusal(BRS_ERROR_STRUCT_SIZE, std::string(what) + "->struct_size is " +
                                             std::to_string(size) +
                                             ", of no known version: was _init called?");
  return size;
}

// What the caller gave; the tail that its header does not know is taken from `defaults`.
template <class T>
T read(const T* given, const T& defaults, const char* what) {
  T value = defaults;
  std::memcpy(&value, given, std::size_t(checked_size(given, what)));
  return value;
}

// As much of `value` as the caller's header knows.
template <class T>
void write(T* out, T value, const char* what) {
  value.struct_size = checked_size(out, what);
  std::memcpy(out, &value, std::size_t(value.struct_size));
}

// The _init functions: no handle, hence no message.
template <class T>
brs_status init(T* out, std::int64_t struct_size, T defaults) noexcept {
  if (!out) return BRS_ERROR_NULL;
  if (!known_size<T>(struct_size)) return BRS_ERROR_STRUCT_SIZE;
  defaults.struct_size = struct_size;
  std::memcpy(out, &defaults, std::size_t(struct_size));
  return BRS_OK;
}

}  // namespace brainshift::capi
