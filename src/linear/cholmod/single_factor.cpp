#include "linear/cholmod/single_factor.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "linear/cholmod/supernodes.hpp"

// Of the BLAS that CHOLMOD stands on.
extern "C" {
void strsv_(const char* uplo, const char* trans, const char* diag, const int* n, const float* a, const int* lda,
            float* x, const int* incx);
void sgemv_(const char* trans, const int* m, const int* n, const float* alpha, const float* a, const int* lda,
            const float* x, const int* incx, const float* beta, float* y, const int* incy);
}

namespace brainshift {
namespace {

constexpr float one = 1.0f, minus_one = -1.0f, zero = 0.0f;
constexpr int next = 1;

const float* entries(const cholmod_factor& factor, const Supernode& node) {
  return static_cast<const float*>(factor.x) + node.at;
}

// Whether each entry has a value in single precision, and each of the diagonal one that can be divided by.
bool can_round(const cholmod_factor& factor) {
  if (!factor.is_super || !factor.x || factor.xtype != CHOLMOD_REAL) return false;
  const Eigen::Map<const Eigen::ArrayXd> all(static_cast<const double*>(factor.x), Eigen::Index(factor.xsize));
  if (!(all.abs().maxCoeff() < double(std::numeric_limits<float>::max()))) return false;
  const Supernodes supernodes(factor);
  for (int s = 0; s < supernodes.count(); ++s) {
    const Supernode node = supernodes[s];
    for (int k = 0; k < node.columns; ++k) {
      if (!(node.x[k + std::ptrdiff_t(k) * node.rows] > double(std::numeric_limits<float>::min()))) return false;
    }
  }
  return true;
}

}  // namespace

bool SingleFactor::take(cholmod_factor& factor) {
  if (!can_round(factor)) return false;
  m_x.resize(factor.n);
  m_below.resize(factor.maxesize);
  char* const bytes = static_cast<char*>(factor.x);
  for (std::size_t i = 0; i < factor.xsize; ++i) {   // from the first on: an entry moves to where none is left
    double entry;
    std::memcpy(&entry, bytes + i * sizeof(double), sizeof entry);
    const auto rounded = float(entry);
    std::memcpy(bytes + i * sizeof(float), &rounded, sizeof rounded);
  }
  m_factor = &factor;
  return true;
}

void SingleFactor::forward() {
  const Supernodes supernodes(*m_factor);
  for (int s = 0; s < supernodes.count(); ++s) {
    const Supernode node = supernodes[s];
    const float* const L = entries(*m_factor, node);
    float* const x = m_x.data() + node.first;
    strsv_("L", "N", "N", &node.columns, L, &node.rows, x, &next);
    const int down = node.rows - node.columns;
    if (down == 0) continue;
    sgemv_("N", &down, &node.columns, &one, L + node.columns, &node.rows, x, &next, &zero, m_below.data(), &next);
    for (int k = 0; k < down; ++k) m_x[std::size_t(node.row[node.columns + k])] -= m_below[std::size_t(k)];
  }
}

void SingleFactor::backward() {
  const Supernodes supernodes(*m_factor);
  for (int s = supernodes.count(); s-- > 0;) {
    const Supernode node = supernodes[s];
    const float* const L = entries(*m_factor, node);
    float* const x = m_x.data() + node.first;
    const int down = node.rows - node.columns;
    for (int k = 0; k < down; ++k) m_below[std::size_t(k)] = m_x[std::size_t(node.row[node.columns + k])];
    if (down > 0) {
      sgemv_("T", &down, &node.columns, &minus_one, L + node.columns, &node.rows, m_below.data(), &next, &one, x,
             &next);
    }
    strsv_("L", "T", "N", &node.columns, L, &node.rows, x, &next);
  }
}

// The right side is scaled to one, so that neither it nor the solution leaves the range of single precision.
void SingleFactor::solve(Eigen::Ref<Eigen::VectorXd> x) {
  const double scale = x.cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return;
  const auto* const place = static_cast<const int*>(m_factor->Perm);
  const std::size_t n = m_factor->n;
  for (std::size_t i = 0; i < n; ++i) m_x[i] = float(x[place[i]] / scale);
  forward();
  backward();
  for (std::size_t i = 0; i < n; ++i) x[place[i]] = scale * double(m_x[i]);
}

}  // namespace brainshift
