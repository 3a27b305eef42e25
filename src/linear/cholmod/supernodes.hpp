// The supernodes of a Cholesky factor of CHOLMOD's: dense columns with the rows they have in common.
#pragma once

#include <algorithm>
#include <vector>

#include <cholmod.h>

namespace brainshift {

struct Supernode {
  int first, columns, rows;   // rows: those of its columns, then those below
  const int* row;
  std::size_t at;             // of its first entry among those of the factor
  const double* x;
};

class Supernodes {
 public:
  explicit Supernodes(const cholmod_factor& f)
      : m_super(static_cast<const int*>(f.super)),
        m_pi(static_cast<const int*>(f.pi)),
        m_px(static_cast<const int*>(f.px)),
        m_s(static_cast<const int*>(f.s)),
        m_x(static_cast<const double*>(f.x)),   // null in a symbolic factor
        m_count(int(f.nsuper)),
        m_of(f.n) {
    for (int s = 0; s < m_count; ++s) {
      std::fill(m_of.begin() + m_super[s], m_of.begin() + m_super[s + 1], s);
    }
  }
  Supernode operator[](int s) const {
    return {m_super[s], m_super[s + 1] - m_super[s], m_pi[s + 1] - m_pi[s], m_s + m_pi[s],
            std::size_t(m_px[s]), m_x ? m_x + m_px[s] : nullptr};
  }
  int of(int column) const { return m_of[std::size_t(column)]; }
  int count() const { return m_count; }

 private:
  const int *m_super, *m_pi, *m_px, *m_s;
  const double* m_x;
  int m_count;
  std::vector<int> m_of;   // columns
};

}  // namespace brainshift
