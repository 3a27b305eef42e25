#include "linear/cholmod/compliance.hpp"

#include <algorithm>
#include <vector>

#include "brainshift/error.hpp"

// Of the BLAS that CHOLMOD stands on.
extern "C" {
void dtrsm_(const char* side, const char* uplo, const char* transa, const char* diag, const int* m,
            const int* n, const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* lda, const double* b, const int* ldb,
            const double* beta, double* c, const int* ldc);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* beta, double* c, const int* ldc);
}

namespace brainshift {
namespace {

constexpr double one = 1.0, zero = 0.0;

struct Supernode {
  int first, columns, rows;   // rows: those of its columns, then those below
  const int* row;
  const double* x;
};

class Supernodes {
 public:
  explicit Supernodes(const cholmod_factor& f)
      : m_super(static_cast<const int*>(f.super)),
        m_pi(static_cast<const int*>(f.pi)),
        m_px(static_cast<const int*>(f.px)),
        m_s(static_cast<const int*>(f.s)),
        m_x(static_cast<const double*>(f.x)),
        m_of(f.n) {
    for (int s = 0; s < int(f.nsuper); ++s) {
      std::fill(m_of.begin() + m_super[s], m_of.begin() + m_super[s + 1], s);
    }
  }
  Supernode operator[](int s) const {
    return {m_super[s], m_super[s + 1] - m_super[s], m_pi[s + 1] - m_pi[s], m_s + m_pi[s],
            m_x + m_px[s]};
  }
  int of(int column) const { return m_of[std::size_t(column)]; }

 private:
  const int *m_super, *m_pi, *m_px, *m_s;
  const double* m_x;
  std::vector<int> m_of;   // columns
};

using Columns = std::vector<int>;

void unite(const Columns& more, Columns& all) {
  Columns both;
  std::set_union(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(both));
  all = std::move(both);
}

}  // namespace

Eigen::MatrixXd supernodal_compliance(const cholmod_factor& factor, const SparseColumns& C) {
  if (!factor.is_super || !factor.x || factor.xtype != CHOLMOD_REAL) {
    throw Error(ErrorCode::internal, "the compliance needs a supernodal factor");
  }
  const Supernodes supernodes(factor);
  const int n = int(factor.n), count = int(C.cols());
  std::vector<int> place(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) place[std::size_t(static_cast<const int*>(factor.Perm)[i])] = i;

  // Transposed, so that what belongs to a row lies together and rows out of reach are never touched.
  std::vector<Columns> reached(factor.nsuper);
  std::vector<Eigen::VectorXd> rest(static_cast<std::size_t>(n));
  const auto row_of = [&](int i) -> Eigen::VectorXd& {
    Eigen::VectorXd& row = rest[std::size_t(i)];
    if (row.size() == 0) row.setZero(count);
    return row;
  };
  for (int c = 0; c < count; ++c) {
    for (SparseColumns::InnerIterator it(C, c); it; ++it) {
      const int i = place[std::size_t(it.row())];
      row_of(i)[c] += it.value();
      Columns& columns = reached[std::size_t(supernodes.of(i))];
      if (columns.empty() || columns.back() != c) columns.push_back(c);
    }
  }

  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(count, count), y, square, below;
  for (int s = 0; s < int(factor.nsuper); ++s) {
    const Columns& active = reached[std::size_t(s)];
    if (active.empty()) continue;
    const Supernode node = supernodes[s];
    const int width = int(active.size()), down = node.rows - node.columns;
    y.resize(width, node.columns);
    for (int k = 0; k < node.columns; ++k) {
      const Eigen::VectorXd& row = row_of(node.first + k);
      for (int a = 0; a < width; ++a) y(a, k) = row[active[std::size_t(a)]];
      rest[std::size_t(node.first + k)].resize(0);
    }
    dtrsm_("R", "L", "T", "N", &width, &node.columns, &one, node.x, &node.rows, y.data(), &width);
    square.resize(width, width);
    dsyrk_("L", "N", &width, &node.columns, &one, y.data(), &width, &zero, square.data(), &width);
    for (int b = 0; b < width; ++b) {
      for (int a = b; a < width; ++a) {
        product(active[std::size_t(a)], active[std::size_t(b)]) += square(a, b);
      }
    }
    if (down == 0) continue;
    below.resize(width, down);
    dgemm_("N", "T", &width, &down, &node.columns, &one, y.data(), &width, node.x + node.columns,
           &node.rows, &zero, below.data(), &width);
    for (int k = 0; k < down; ++k) {
      Eigen::VectorXd& row = row_of(node.row[node.columns + k]);
      for (int a = 0; a < width; ++a) row[active[std::size_t(a)]] -= below(a, k);
    }
    unite(active, reached[std::size_t(supernodes.of(node.row[node.columns]))]);
    reached[std::size_t(s)].clear();
  }
  return product.selfadjointView<Eigen::Lower>();
}

}  // namespace brainshift
