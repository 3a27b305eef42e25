#include "beam/block_tridiagonal.hpp"

#include <cmath>

#include <Eigen/Dense>

namespace brainshift {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

// L D L^T in place: unit L strictly below the diagonal, D on it. A pivot counts as zero when
// elimination has left nothing but rounding of the entry it came from.
bool factorise_block(Mat6& a, const Vec6& scale, Index& negative) {
  constexpr double rounding = 1e-15;
  for (int j = 0; j < 6; ++j) {
    double pivot = a(j, j);
    for (int k = 0; k < j; ++k) pivot -= a(j, k) * a(j, k) * a(k, k);
    if (!std::isfinite(pivot) || std::abs(pivot) <= rounding * std::abs(scale[j])) return false;
    if (pivot < 0.0) ++negative;
    a(j, j) = pivot;
    for (int i = j + 1; i < 6; ++i) {
      double sum = a(i, j);
      for (int k = 0; k < j; ++k) sum -= a(i, k) * a(j, k) * a(k, k);
      a(i, j) = sum / pivot;
    }
  }
  return true;
}

}  // namespace

BlockTridiagonal::BlockTridiagonal(Index blocks)
    : m_diagonal(std::size_t(blocks), Mat6::Zero()),
      m_lower(std::size_t(blocks > 0 ? blocks - 1 : 0), Mat6::Zero()) {}

void BlockTridiagonal::set_zero() {
  for (Mat6& block : m_diagonal) block.setZero();
  for (Mat6& block : m_lower) block.setZero();
}

void BlockTridiagonal::add_element(Index i, const Mat12& matrix) {
  diagonal(i) += matrix.topLeftCorner<6, 6>();
  diagonal(i + 1) += matrix.bottomRightCorner<6, 6>();
  lower(i) += matrix.bottomLeftCorner<6, 6>();
}

void BlockTridiagonal::fix(Index dof) {
  const Index i = dof / 6, k = dof % 6;
  Mat6& block = diagonal(i);
  const double kept = block(k, k) > 0.0 ? block(k, k) : 1.0;
  block.row(k).setZero();
  block.col(k).setZero();
  block(k, k) = kept;
  if (i > 0) lower(i - 1).row(k).setZero();
  if (i + 1 < blocks()) lower(i).col(k).setZero();
}

void BlockTridiagonal::fix_spin(Index i, const Vec3& axis) {
  Eigen::Matrix<double, 6, 1> held = Eigen::Matrix<double, 6, 1>::Zero();
  held.tail<3>() = axis;
  const Mat6 project = Mat6::Identity() - held * held.transpose();
  Mat6& block = diagonal(i);
  const double along = held.dot(block * held), kept = along > 0.0 ? along : 1.0;
  block = (project * block * project + kept * held * held.transpose()).eval();
  if (i > 0) lower(i - 1) = (project * lower(i - 1)).eval();
  if (i + 1 < blocks()) lower(i) = (lower(i) * project).eval();
}

Eigen::VectorXd BlockTridiagonal::multiply(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y(x.size());
  for (Index i = 0; i < blocks(); ++i) y.segment<6>(6 * i) = diagonal(i) * x.segment<6>(6 * i);
  for (Index i = 0; i + 1 < blocks(); ++i) {
    y.segment<6>(6 * i + 6) += lower(i) * x.segment<6>(6 * i);
    y.segment<6>(6 * i) += lower(i).transpose() * x.segment<6>(6 * i + 6);
  }
  return y;
}

Eigen::VectorXd BlockTridiagonal::diagonal_entries() const {
  Eigen::VectorXd d(rows());
  for (Index i = 0; i < blocks(); ++i) d.segment<6>(6 * i) = diagonal(i).diagonal();
  return d;
}

Eigen::MatrixXd BlockTridiagonal::dense() const {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(rows(), rows());
  for (Index i = 0; i < blocks(); ++i) m.block<6, 6>(6 * i, 6 * i) = diagonal(i);
  for (Index i = 0; i + 1 < blocks(); ++i) {
    m.block<6, 6>(6 * i + 6, 6 * i) = lower(i);
    m.block<6, 6>(6 * i, 6 * i + 6) = lower(i).transpose();
  }
  return m;
}

bool BlockTridiagonalFactor::factorise(const BlockTridiagonal& matrix) {
  const Index count = matrix.blocks();
  m_diagonal.resize(std::size_t(count));
  m_lower.resize(std::size_t(count > 0 ? count - 1 : 0));
  m_negative = 0;
  m_usable = false;
  for (Index i = 0; i < count; ++i) {
    Mat6& block = m_diagonal[std::size_t(i)];
    block = matrix.diagonal(i);
    if (i > 0) {
      // with the block above = L D L^T and B its neighbour below: W = L^-1 B^T, the block of the
      // factor is W^T D^-1, and the Schur complement A - W^T D^-1 W
      const Mat6& above = m_diagonal[std::size_t(i) - 1];
      Mat6 W = matrix.lower(i - 1).transpose();
      above.triangularView<Eigen::UnitLower>().solveInPlace(W);
      Mat6& lower = m_lower[std::size_t(i) - 1];
      lower = W.transpose() * above.diagonal().cwiseInverse().asDiagonal();
      block.noalias() -= lower * W;
    }
    if (!factorise_block(block, matrix.diagonal(i).diagonal(), m_negative)) return false;
  }
  m_usable = true;
  return true;
}

void BlockTridiagonalFactor::solve(Eigen::Ref<Eigen::MatrixXd> x) const {
  const Index count = Index(m_diagonal.size());
  for (Index i = 0; i < count; ++i) {
    auto part = x.middleRows<6>(6 * i);
    if (i > 0) part.noalias() -= m_lower[std::size_t(i) - 1] * x.middleRows<6>(6 * i - 6);
    m_diagonal[std::size_t(i)].triangularView<Eigen::UnitLower>().solveInPlace(part);
  }
  for (Index i = count - 1; i >= 0; --i) {
    const Mat6& block = m_diagonal[std::size_t(i)];
    auto part = x.middleRows<6>(6 * i);
    part = block.diagonal().cwiseInverse().asDiagonal() * part;
    if (i + 1 < count) {
      part.noalias() -= m_lower[std::size_t(i)].transpose() * x.middleRows<6>(6 * i + 6);
    }
    block.triangularView<Eigen::UnitLower>().transpose().solveInPlace(part);
  }
}

}  // namespace brainshift
