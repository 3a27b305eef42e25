// Numbers from bytes: small ones, and those that do harm.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace brainshift::test {

class Numbers {
 public:
  Numbers(const std::uint8_t* data, std::size_t size) : m_at(data), m_end(data + size) {}

  bool more() const { return m_at < m_end; }
  std::uint8_t byte() { return m_at < m_end ? *m_at++ : 0; }
  // Most are multiples of 1/16 within 8 of zero.
  double number() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double special[] = {
        0.0,   -0.0,      1e-300,   -1e-160,
        1e150, 1e308,     5e-324,   1e-16,
        1e-12, 1.0 / 3.0, 1e-6,     1e6,
        1e12,  -infinity, infinity, std::numeric_limits<double>::quiet_NaN()};
    const int b = byte();
    return b < 16 ? special[b] : (b - 136) / 16.0;
  }

 private:
  const std::uint8_t *m_at, *m_end;
};

}  // namespace brainshift::test
