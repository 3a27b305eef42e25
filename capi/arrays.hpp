// Arrays of the caller, copied. By memcpy: they need no alignment.
#pragma once

#include <algorithm>
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

// An option that is an int in the library; none of them may be negative.
inline int checked_int(std::int64_t value, const char* what) {
  if (value < 0 || value > std::numeric_limits<int>::max())
    throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                  what + (" is " + std::to_string(value)) + ", negative or too large");
  return int(value);
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

// Writes an answer; `into` holds as much as it.
template <class Matrix>
void write_array(const Matrix& values, typename Matrix::Scalar* into) {
  if (values.size() > 0)
    std::memcpy(into, values.data(), std::size_t(values.size()) * sizeof *into);
}

// d1, d2, d3 of each node: column by column, one matrix after another.
inline const double* view_of_frames(const std::vector<Mat3>& frames) {
  static_assert(sizeof(Mat3) == 9 * sizeof(double));
  return frames.empty() ? nullptr : frames.front().data();
}

// The functions that fill what the caller has room for, and say how much there is.
template <class T>
void write_list(const T* values, std::size_t size, T* into, std::int64_t capacity,
                std::int64_t* count, const char* what) {
  const auto room = std::size_t(checked_count(capacity, what));
  require_array(into, capacity, what);
  result(count, "count") = std::int64_t(size);
  const std::size_t written = size < room ? size : room;
  if (written > 0) std::memcpy(into, values, written * sizeof(T));
}

inline Vec3 vector3(const double* values, const char* what) {
  Vec3 v;
  std::memcpy(v.data(), &result(values, what), 3 * sizeof(double));
  return v;
}

// The remark of functions that look for points in the mesh.
inline brs_status remark_outside(Context& context, Eigen::Index outside, Eigen::Index points) {
  if (outside == 0) return BRS_OK;
  const std::string remark =
      std::to_string(outside) + " of " + std::to_string(points) + " points lie outside the mesh";
  context.say(remark.c_str());
  return BRS_OUTSIDE;
}

inline brs_status remark_outside(Context& context, const Indices& tets) {
  return remark_outside(context, std::count(tets.begin(), tets.end(), -1),
                        Eigen::Index(tets.size()));
}

inline std::string text(const char* characters, const char* what) {
  return &result(characters, what);
}

}  // namespace brainshift::capi
