// Values as bytes, little-endian whatever the machine, in a sealed envelope: magic, kind, version of
// the format, length, content, checksum.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "brainshift/error.hpp"
#include "brainshift/types.hpp"

namespace brainshift {

// Changes whenever the content of either kind does.
constexpr std::uint32_t bytes_version = 1;

enum class BytesKind : std::uint32_t { snapshot = 1, recording = 2 };

// FNV-1a, 64 bits. Each step is one-to-one, so that a single damaged byte never goes unnoticed.
std::uint64_t checksum(const std::uint8_t* bytes, std::size_t count);

class ByteWriter {
 public:
  template <class T>
  std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>> put(T value) {
    std::uint64_t bits = 0;
    if constexpr (std::is_same_v<T, double>) {
      std::memcpy(&bits, &value, sizeof bits);
    } else {
      bits = std::uint64_t(std::int64_t(value));
    }
    for (int i = 0; i < 8; ++i) m_bytes.push_back(std::uint8_t(bits >> 8 * i));
  }
  void put(const std::string& text) { put_raw(text); }
  void put(const Bytes& bytes) { put_raw(bytes); }
  template <class T>
  void put(const std::vector<T>& values) {
    put(values.size());
    for (const T& value : values) put(value);
  }
  // Rows, then the coefficients row by row.
  template <class Derived>
  void put(const Eigen::MatrixBase<Derived>& m) {
    put(m.rows());
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j) put(m(i, j));
  }

  const Bytes& content() const { return m_bytes; }
  Bytes sealed(BytesKind kind) const;

 private:
  template <class Text>
  void put_raw(const Text& text) {
    put(text.size());
    m_bytes.insert(m_bytes.end(), text.begin(), text.end());
  }

  Bytes m_bytes;
};

// All throw Error(file) where the bytes end too early or hold what cannot be.
class ByteReader {
 public:
  // Of a sealed envelope; throws Error(file) unless it is whole, of this kind and this version.
  ByteReader(const Bytes& sealed, BytesKind kind);

  template <class T>
  T get() {
    if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, Bytes>) {
      const std::size_t size = count(1);
      const std::uint8_t* text = take(size);
      return T(text, text + size);
    } else {
      const std::uint64_t bits = word();
      T value;
      if constexpr (std::is_same_v<T, double>) {
        std::memcpy(&value, &bits, sizeof value);
      } else {
        const auto number = std::int64_t(bits);
        value = T(number);
        if (std::int64_t(value) != number) fail("a number is out of range");
      }
      return value;
    }
  }
  template <class T>
  std::vector<T> list() {
    std::vector<T> values(count(8));
    for (T& value : values) value = get<T>();
    return values;
  }
  template <class Matrix>
  Matrix matrix() {
    constexpr auto columns = Eigen::Index(Matrix::ColsAtCompileTime);
    constexpr auto fixed = Eigen::Index(Matrix::RowsAtCompileTime);
    const auto rows = Eigen::Index(count(8 * std::size_t(columns)));
    if (fixed != Eigen::Dynamic && rows != fixed) fail("a matrix has another size");
    Matrix m(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i)
      for (Eigen::Index j = 0; j < columns; ++j) m(i, j) = get<typename Matrix::Scalar>();
    return m;
  }
  // A number of items of at least `size` bytes each: more than there is room for is refused before
  // anything is allocated.
  std::size_t count(std::size_t size);
  void expect_end() const;
  [[noreturn]] static void fail(const std::string& what);

 private:
  std::uint64_t word();
  const std::uint8_t* take(std::size_t size);

  const std::uint8_t* m_at;
  const std::uint8_t* m_end;
};

}  // namespace brainshift
