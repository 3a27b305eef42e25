// Arrays of the caller, copied. By memcpy: they need no alignment.
#pragma once

#include <cstring>
#include <limits>
#include <string>

#include "guard.hpp"

namespace brainshift::capi {

// A count that fits the indices of the library.
inline Index checked_count(std::int64_t count, const char* what) {
  if (count < 0 || count > std::numeric_limits<Index>::max())
    throw Refusal(BRS_ERROR_SIZE, "the number of " + std::string(what) + " is " +
                                      std::to_string(count) + ", not from 0 to 2147483647");
  return Index(count);
}

inline void require_array(const void* values, std::int64_t count, const char* what) {
  if (!values && count > 0)
    throw Refusal(BRS_ERROR_NULL,
                  "the array of " + std::to_string(count) + " " + what + " is NULL");
}

// Points, Tets, Triangles: `count` rows of a row-major array.
template <class Matrix>
Matrix rows(const typename Matrix::Scalar* values, std::int64_t count, const char* what) {
  Matrix matrix(checked_count(count, what), Eigen::Index(Matrix::ColsAtCompileTime));
  require_array(values, count, what);
  if (matrix.size() > 0)
    std::memcpy(matrix.data(), values, std::size_t(matrix.size()) * sizeof *values);
  return matrix;
}

inline Indices indices(const std::int32_t* values, std::int64_t count, const char* what) {
  const auto size = std::size_t(checked_count(count, what));
  require_array(values, count, what);
  Indices list(size);
  if (size > 0) std::memcpy(list.data(), values, size * sizeof *values);
  return list;
}

inline Vec3 vector3(const double* values, const char* what) {
  Vec3 v;
  std::memcpy(v.data(), &result(values, what), 3 * sizeof(double));
  return v;
}

inline std::string text(const char* characters, const char* what) {
  return &result(characters, what);
}

}  // namespace brainshift::capi
