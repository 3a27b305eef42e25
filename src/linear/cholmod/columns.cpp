#include "linear/cholmod/columns.hpp"

#include <algorithm>
#include <iterator>

#include "brainshift/error.hpp"
#include "linear/cholmod/supernodes.hpp"

// Of the BLAS that CHOLMOD stands on.
extern "C" {
void dtrsm_(const char* side, const char* uplo, const char* transa, const char* diag, const int* m,
            const int* n, const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* lda, const double* b, const int* ldb,
            const double* beta, double* c, const int* ldc);
void dtrsv_(const char* uplo, const char* trans, const char* diag, const int* n, const double* a, const int* lda,
            double* x, const int* incx);
void dgemv_(const char* trans, const int* m, const int* n, const double* alpha, const double* a, const int* lda,
            const double* x, const int* incx, const double* beta, double* y, const int* incy);
}

namespace brainshift {
namespace {

constexpr double one = 1.0, zero = 0.0;
constexpr int few = 4;   // columns that are quicker one by one: the dense kernels copy a supernode first

// y := y L^-T with the triangle of a supernode; y: a right side per row.
void solve_triangle(const Supernode& node, Eigen::MatrixXd& y) {
  const int width = int(y.rows());
  if (width > few) {
    dtrsm_("R", "L", "T", "N", &width, &node.columns, &one, node.x, &node.rows, y.data(), &width);
    return;
  }
  for (int a = 0; a < width; ++a) {
    dtrsv_("L", "N", "N", &node.columns, node.x, &node.rows, y.data() + a, &width);
  }
}

// y B^T with the rows B of a supernode below its triangle.
void multiply_below(const Supernode& node, const Eigen::MatrixXd& y, Eigen::MatrixXd& below) {
  const int width = int(y.rows()), down = node.rows - node.columns;
  below.resize(width, down);
  const double* B = node.x + node.columns;
  if (width > few) {
    dgemm_("N", "T", &width, &down, &node.columns, &one, y.data(), &width, B, &node.rows, &zero, below.data(),
           &width);
    return;
  }
  for (int a = 0; a < width; ++a) {
    dgemv_("N", &down, &node.columns, &one, B, &node.rows, y.data() + a, &width, &zero, below.data() + a, &width);
  }
}

using Columns = std::vector<int>;

void unite(const Columns& more, Columns& all) {
  Columns both;
  std::set_union(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(both));
  all = std::move(both);
}

// What is still to be taken off the right sides: transposed, so that what belongs to a row lies together
// and rows out of reach are never touched.
class Rest {
 public:
  Rest(std::size_t rows, int columns) : m_rows(rows), m_columns(columns) {}
  Eigen::VectorXd& operator[](int i) {
    Eigen::VectorXd& row = m_rows[std::size_t(i)];
    if (row.size() == 0) row.setZero(m_columns);
    return row;
  }
  void forget(int i) { m_rows[std::size_t(i)].resize(0); }

 private:
  std::vector<Eigen::VectorXd> m_rows;
  int m_columns;
};

}  // namespace

std::vector<std::int64_t> FactorColumns::reach(const cholmod_factor& factor, const SparseColumns& C) {
  const Supernodes supernodes(factor);
  std::vector<int> place(factor.n);
  for (int i = 0; i < int(factor.n); ++i) place[std::size_t(static_cast<const int*>(factor.Perm)[i])] = i;
  std::vector<std::int64_t> entries(std::size_t(C.cols()), 0);
  std::vector<int> seen(factor.nsuper, -1);   // by which column last
  for (int c = 0; c < int(C.cols()); ++c) {
    for (SparseColumns::InnerIterator it(C, c); it; ++it) {
      for (int s = supernodes.of(place[std::size_t(it.row())]); seen[std::size_t(s)] != c;) {
        const Supernode node = supernodes[s];
        seen[std::size_t(s)] = c;
        entries[std::size_t(c)] += node.columns;
        if (node.rows > node.columns) s = supernodes.of(node.row[node.columns]);
      }
    }
  }
  return entries;
}

void FactorColumns::clear() {
  m_parts.clear();
  m_product.resize(0, 0);
  m_count = 0;
}

void FactorColumns::keep(Eigen::Index count) {
  for (std::vector<Part>& parts : m_parts) {
    while (!parts.empty() && parts.back().columns.front() >= count) parts.pop_back();
  }
  m_product.conservativeResize(count, count);
  m_count = count;
}

// Products of a new part of supernode s with itself and with what stands there already.
void FactorColumns::multiply(const Part& part, int s) {
  const int width = int(part.columns.size()), rows = int(part.y.cols());
  Eigen::MatrixXd products;
  const auto add = [&](const Part& other) {
    const int others = int(other.columns.size());
    products.resize(width, others);
    dgemm_("N", "T", &width, &others, &rows, &one, part.y.data(), &width, other.y.data(), &others, &zero,
           products.data(), &width);
    for (int b = 0; b < others; ++b) {
      for (int a = 0; a < width; ++a) {
        m_product(part.columns[std::size_t(a)], other.columns[std::size_t(b)]) += products(a, b);
      }
    }
  };
  for (const Part& other : m_parts[std::size_t(s)]) add(other);
  add(part);
}

void FactorColumns::append(const cholmod_factor& factor, const SparseColumns& C) {
  if (!factor.is_super || !factor.x || factor.xtype != CHOLMOD_REAL) {
    throw Error(ErrorCode::internal, "columns need a supernodal factor");
  }
  const Supernodes supernodes(factor);
  const int n = int(factor.n), count = int(C.cols()), before = int(m_count);
  m_parts.resize(factor.nsuper);
  m_count += count;
  m_product.conservativeResizeLike(Eigen::MatrixXd::Zero(m_count, m_count));
  std::vector<int> place(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) place[std::size_t(static_cast<const int*>(factor.Perm)[i])] = i;

  std::vector<Columns> reached(factor.nsuper);
  Rest rest(std::size_t(n), count);
  for (int c = 0; c < count; ++c) {
    for (SparseColumns::InnerIterator it(C, c); it; ++it) {
      const int i = place[std::size_t(it.row())];
      rest[i][c] += it.value();
      Columns& columns = reached[std::size_t(supernodes.of(i))];
      if (columns.empty() || columns.back() != c) columns.push_back(c);
    }
  }
  Eigen::MatrixXd below;
  for (int s = 0; s < int(factor.nsuper); ++s) {
    const Columns active = std::move(reached[std::size_t(s)]);
    if (active.empty()) continue;
    const Supernode node = supernodes[s];
    const int width = int(active.size()), down = node.rows - node.columns;
    Part part{node.first, active, Eigen::MatrixXd(width, node.columns)};
    for (int k = 0; k < node.columns; ++k) {
      const Eigen::VectorXd& row = rest[node.first + k];
      for (int a = 0; a < width; ++a) part.y(a, k) = row[active[std::size_t(a)]];
      rest.forget(node.first + k);
    }
    for (int& c : part.columns) c += before;
    solve_triangle(node, part.y);
    multiply(part, s);
    if (down > 0) {
      multiply_below(node, part.y, below);
      for (int k = 0; k < down; ++k) {
        Eigen::VectorXd& row = rest[node.row[node.columns + k]];
        for (int a = 0; a < width; ++a) row[active[std::size_t(a)]] -= below(a, k);
      }
      unite(active, reached[std::size_t(supernodes.of(node.row[node.columns]))]);
    }
    m_parts[std::size_t(s)].push_back(std::move(part));
  }
  m_product.topRightCorner(before, count) = m_product.bottomLeftCorner(count, before).transpose();
  for (Eigen::Index c = before; c < m_count; ++c) {   // rounding of the two triangles may differ
    for (Eigen::Index r = before; r < c; ++r) m_product(r, c) = m_product(c, r);
  }
}

Eigen::VectorXd FactorColumns::project(const Eigen::VectorXd& z) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(m_count);
  for (const std::vector<Part>& parts : m_parts) {
    for (const Part& part : parts) {
      const Eigen::VectorXd products = part.y * z.segment(part.first, part.y.cols());
      for (std::size_t a = 0; a < part.columns.size(); ++a) {
        result[part.columns[a]] += products[Eigen::Index(a)];
      }
    }
  }
  return result;
}

void FactorColumns::add(const Eigen::VectorXd& a, Eigen::VectorXd& z) const {
  for (const std::vector<Part>& parts : m_parts) {
    for (const Part& part : parts) {
      Eigen::VectorXd picked(part.y.rows());
      for (std::size_t k = 0; k < part.columns.size(); ++k) picked[Eigen::Index(k)] = a[part.columns[k]];
      z.segment(part.first, part.y.cols()) += part.y.transpose() * picked;
    }
  }
}

}  // namespace brainshift
