#include "contact/reduction.hpp"

#include <cmath>
#include <utility>

namespace brainshift {
namespace {

// Rows whose directions differ by less than this (sine of the angle) count as dependent.
constexpr double dependence = 1e-6;

Vec3 axis_far_from(const Vec3& a) {
  if (std::abs(a.x()) > std::abs(a.y()) || std::abs(a.x()) > std::abs(a.z())) {
    return std::abs(a.y()) <= std::abs(a.z()) ? Vec3::UnitY() : Vec3::UnitZ();
  }
  return Vec3::UnitX();
}

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
          a.x() * b.y() - a.y() * b.x()};
}

}  // namespace

Mat3 Reduction::Block::free() const {
  Mat3 f = q;
  for (int k = 0; k < held; ++k) f.col(k).setZero();
  return f;
}

Reduction::Reduction(Index blocks, const std::vector<NodeRow>& rows, const Reduction* like)
    : m_blocks(std::size_t(blocks)), m_values(std::size_t(blocks), Vec3::Zero()) {
  for (const NodeRow& row : rows) add_row(row, like);
  m_particular.setZero(3 * blocks);
  std::vector<Index> pairs;
  for (Index i = 0; i < blocks; ++i) {
    Block& b = m_blocks[std::size_t(i)];
    if (b.plain) continue;
    // Complete the held directions to an orthonormal basis.
    if (b.held == 1) {
      const Vec3 n = b.q.col(0);
      const bool follow = like && like->m_blocks[std::size_t(i)].held == 1;
      const Vec3 axis = follow ? Vec3(like->m_blocks[std::size_t(i)].q.col(1)) : axis_far_from(n);
      b.q.col(1) = (axis - axis.dot(n) * n).normalized();
    }
    if (b.held <= 2) b.q.col(2) = cross(b.q.col(0), b.q.col(1));
    // lower * beta = values, lower triangular; dx = sum beta_k q_k.
    const auto solve = [&b](Vec3 rhs) {
      Vec3 beta = Vec3::Zero();
      for (int k = 0; k < b.held; ++k) {
        for (int j = 0; j < k; ++j) rhs[k] -= b.lower(k, j) * beta[j];
        beta[k] = rhs[k] / b.lower(k, k);
      }
      return Vec3(b.q * beta);
    };
    m_particular.segment<3>(3 * i) = solve(m_values[std::size_t(i)]);
    if (b.pair >= 0) {
      b.pair_response = solve(Vec3::Unit(b.pair));
      pairs.push_back(i);
    }
  }
  for (Index i : pairs) {  // partners hold no pair of their own, so their c is final
    const Block& b = m_blocks[std::size_t(i)];
    const Vec3 partner = m_particular.segment<3>(3 * b.partner);
    m_particular.segment<3>(3 * i) += b.pair_response * b.pair_normal.dot(partner);
  }
}

// What of `normal` the rows of the block leave free; `along`: its parts along the held directions.
Vec3 Reduction::Block::rest_of(const Vec3& normal, Vec3& along) const {
  Vec3 rest = normal;
  along.setZero();
  for (int pass = 0; pass < 2; ++pass) {  // twice is enough (Kahan, Parlett)
    for (int k = 0; k < held; ++k) {
      const double c = rest.dot(q.col(k));
      along[k] += c;
      rest -= c * q.col(k);
    }
  }
  return rest;
}

// A pair row is eliminated at the block given, or at its partner where the rows of the block leave
// too little of its direction: a held block still holds its partner.
void Reduction::add_row(NodeRow row, const Reduction* like) {
  Vec3 along;
  if (row.partner >= 0) {
    const Block& here = m_blocks[std::size_t(row.block)];
    const Block& there = m_blocks[std::size_t(row.partner)];
    if (here.pair >= 0 || there.pair >= 0) return;
    const bool turn = like ? like->m_blocks[std::size_t(row.partner)].pair >= 0
                           : here.rest_of(row.normal, along).norm() <
                                 0.5 * there.rest_of(row.normal, along).norm();
    if (turn) {
      std::swap(row.block, row.partner);
      row.normal = -row.normal;
    }
  }
  Block& b = m_blocks[std::size_t(row.block)];
  if (b.held == 3) return;
  const Vec3 rest = b.rest_of(row.normal, along);
  const double length = rest.norm();
  if (!(length > dependence * row.normal.norm())) return;
  b.plain = false;
  b.q.col(b.held) = rest / length;
  for (int k = 0; k < b.held; ++k) b.lower(b.held, k) = along[k];
  b.lower(b.held, b.held) = length;
  b.tags[b.held] = row.tag;
  m_values[std::size_t(row.block)][b.held] = row.value;
  if (row.partner >= 0) {
    b.pair = b.held;
    b.partner = row.partner;
    b.pair_normal = row.normal;
  }
  ++b.held;
}

Mat3 Reduction::coupling(const Block& b) const {
  return b.pair_response * (b.pair_normal.transpose() * m_blocks[std::size_t(b.partner)].free());
}

void Reduction::reduce(const BlockMatrix& K, double diagonal, BlockMatrix& A) const {
  A.set_zero();
  for (Index j = 0; j < K.blocks(); ++j) {
    const Block& bj = m_blocks[std::size_t(j)];
    const Index count = Index(K.rows_end(j) - K.rows_begin(j));
    for (Index k = 0; k < count; ++k) {
      const Index i = K.rows_begin(j)[k];
      const Block& bi = m_blocks[std::size_t(i)];
      const BlockMatrix::Slot slot = K.slot_at(j, k);
      const Mat3 block = K.get(slot);
      if (bi.plain && bj.plain) {
        A.add(slot, block);
        continue;
      }
      // (own block, partner) of the row side and of the column side
      const Mat3 left[2] = {bi.free(), bi.pair >= 0 ? coupling(bi) : Mat3(Mat3::Zero())};
      const Mat3 right[2] = {bj.free(), bj.pair >= 0 ? coupling(bj) : Mat3(Mat3::Zero())};
      const Index to_row[2] = {i, bi.partner}, to_col[2] = {j, bj.partner};
      for (int p = 0; p < (bi.pair >= 0 ? 2 : 1); ++p) {
        for (int q = 0; q < (bj.pair >= 0 ? 2 : 1); ++q) {
          if (i == j && p < q) continue;  // its transpose comes with p > q
          const Mat3 part = left[p].transpose() * block * right[q];
          if (to_row[p] == to_col[q] && i != j) {
            A.add_at(to_row[p], to_row[p], part + part.transpose());  // K_ij and K_ji
          } else {
            A.add_at(to_row[p], to_col[q], part);
          }
        }
      }
    }
  }
  for (Index i = 0; i < K.blocks(); ++i) {
    const Block& b = m_blocks[std::size_t(i)];
    if (b.plain) continue;
    Vec3 fill = Vec3::Zero();
    for (int k = 0; k < b.held; ++k) fill[k] = diagonal;
    A.add(A.slot_at(i, 0), fill.asDiagonal().toDenseMatrix());
  }
}

Eigen::VectorXd Reduction::restrict_force(const Eigen::VectorXd& v) const {
  Eigen::VectorXd y = v;
  for (std::size_t i = 0; i < m_blocks.size(); ++i) {
    const Block& b = m_blocks[i];
    if (b.pair >= 0) {  // v on the block is felt by the partner through the pair row
      y.segment<3>(3 * b.partner) +=
          b.pair_normal * b.pair_response.dot(v.segment<3>(3 * Eigen::Index(i)));
    }
  }
  for (std::size_t i = 0; i < m_blocks.size(); ++i) {
    if (!m_blocks[i].plain) {
      const Vec3 force = y.segment<3>(3 * Eigen::Index(i));
      y.segment<3>(3 * Eigen::Index(i)) = m_blocks[i].free().transpose() * force;
    }
  }
  return y;
}

SparseColumns Reduction::restrict_columns(const SparseColumns& forces) const {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index block, const Vec3& force, int column) {
    const Block& b = m_blocks[std::size_t(block)];
    const Vec3 felt = b.plain ? force : Vec3(b.free().transpose() * force);
    for (int k = 0; k < 3; ++k) entries.emplace_back(3 * block + k, column, felt[k]);
  };
  for (int c = 0; c < int(forces.cols()); ++c) {
    for (SparseColumns::InnerIterator it(forces, c); it; ++it) {
      const Index block = Index(it.row()) / 3;
      const Vec3 force = it.value() * Vec3::Unit(it.row() % 3);
      add(block, force, c);
      const Block& b = m_blocks[std::size_t(block)];
      if (b.pair >= 0) add(b.partner, b.pair_normal * b.pair_response.dot(force), c);
    }
  }
  SparseColumns result(forces.rows(), forces.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::VectorXd Reduction::expand(const Eigen::VectorXd& y) const {
  Eigen::VectorXd dx = y;
  for (std::size_t i = 0; i < m_blocks.size(); ++i) {
    if (!m_blocks[i].plain) {
      dx.segment<3>(3 * Eigen::Index(i)) =
          m_blocks[i].free() * Vec3(y.segment<3>(3 * Eigen::Index(i)));
    }
  }
  for (std::size_t i = 0; i < m_blocks.size(); ++i) {
    const Block& b = m_blocks[i];
    if (b.pair >= 0) {
      dx.segment<3>(3 * Eigen::Index(i)) +=
          b.pair_response * b.pair_normal.dot(dx.segment<3>(3 * b.partner));
    }
  }
  return dx;
}

std::vector<Reduction::Held> Reduction::held_rows() const {
  std::vector<Held> rows;
  for (std::size_t i = 0; i < m_blocks.size(); ++i) {
    for (int k = 0; k < m_blocks[i].held; ++k) rows.push_back({m_blocks[i].tags[k], Index(i)});
  }
  return rows;
}

SparseColumns Reduction::released(const Indices& blocks, std::size_t kept,
                                  std::vector<std::size_t>& tags) const {
  std::vector<Indices> followers(m_blocks.size());   // through a pair row
  for (std::size_t i = 0; i < m_blocks.size(); ++i) {
    if (m_blocks[i].pair >= 0) followers[std::size_t(m_blocks[i].partner)].push_back(Index(i));
  }
  std::vector<Eigen::Triplet<double>> entries;
  int column = 0;
  const auto add = [&](Index block, const Vec3& motion) {
    for (int k = 0; k < 3; ++k) entries.emplace_back(3 * block + k, column, motion[k]);
  };
  for (Index block : blocks) {
    const Block& b = m_blocks[std::size_t(block)];
    for (int k = 0; k < b.held; ++k) {
      if (b.tags[k] == kept) continue;
      const Vec3 motion = b.q.col(k);
      add(block, motion);
      for (Index i : followers[std::size_t(block)]) {
        const Block& f = m_blocks[std::size_t(i)];
        add(i, f.pair_response * f.pair_normal.dot(motion));
      }
      tags.push_back(b.tags[k]);
      ++column;
    }
  }
  SparseColumns result(3 * Eigen::Index(m_blocks.size()), column);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void Reduction::multipliers(const Eigen::VectorXd& unbalanced, std::vector<double>& by_tag) const {
  Eigen::VectorXd force = unbalanced;
  // Blocks with a pair row first: their reaction loads the partner.
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < m_blocks.size(); ++i) {
      const Block& b = m_blocks[i];
      if (b.plain || (b.pair >= 0) != (pass == 0)) continue;
      // sum_k multiplier_k normal_k = -force along the held directions: lower^T m = -q^T force.
      Vec3 rhs = -b.q.transpose() * force.segment<3>(3 * Eigen::Index(i));
      for (int k = b.held - 1; k >= 0; --k) {
        for (int j = k + 1; j < b.held; ++j) rhs[k] -= b.lower(j, k) * rhs[j];
        rhs[k] /= b.lower(k, k);
        by_tag[b.tags[k]] = rhs[k];
      }
      if (b.pair >= 0) force.segment<3>(3 * b.partner) -= rhs[b.pair] * b.pair_normal;
    }
  }
}

Eigen::VectorXd Reduction::project(const Eigen::VectorXd& force) const {
  Eigen::VectorXd rest = restrict_force(force);
  // Back to Cartesian axes of each block, so that norms do not depend on the local ones.
  for (std::size_t i = 0; i < m_blocks.size(); ++i) {
    if (!m_blocks[i].plain) {
      rest.segment<3>(3 * Eigen::Index(i)) =
          m_blocks[i].q * Vec3(rest.segment<3>(3 * Eigen::Index(i)));
    }
  }
  return rest;
}

}  // namespace brainshift
