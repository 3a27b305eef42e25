#include "contact/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <map>
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
    : m_place(std::size_t(blocks), -1) {
  for (const NodeRow& row : rows) add_row(row, like);
  sort_blocks();
  for (Block& b : m_held) complete_axes(b, like);
  m_particular.setZero(3 * blocks);
  find_particular();
}

const Reduction::Block* Reduction::find(Index block) const {
  const int place = m_place[std::size_t(block)];
  return place < 0 ? nullptr : &m_held[std::size_t(place)];
}

Reduction::Block& Reduction::hold(Index block) {
  int& place = m_place[std::size_t(block)];
  if (place < 0) {
    place = int(m_held.size());
    m_held.emplace_back();
    m_held.back().block = block;
  }
  return m_held[std::size_t(place)];
}

void Reduction::sort_blocks() {
  std::sort(m_held.begin(), m_held.end(), [](const Block& a, const Block& b) { return a.block < b.block; });
  for (std::size_t k = 0; k < m_held.size(); ++k) m_place[std::size_t(m_held[k].block)] = int(k);
}

// Completes the held directions to an orthonormal basis.
void Reduction::complete_axes(Block& b, const Reduction* like) const {
  if (b.held == 1) {
    const Vec3 n = b.q.col(0);
    const Block* other = like ? like->find(b.block) : nullptr;
    const Vec3 axis = other && other->held == 1 ? Vec3(other->q.col(1)) : axis_far_from(n);
    b.q.col(1) = (axis - axis.dot(n) * n).normalized();
  }
  if (b.held <= 2) b.q.col(2) = cross(b.q.col(0), b.q.col(1));
}

void Reduction::find_particular() {
  for (Block& b : m_held) {
    // lower * beta = values, lower triangular; dx = sum beta_k q_k.
    const auto solve = [&b](Vec3 rhs) {
      Vec3 beta = Vec3::Zero();
      for (int k = 0; k < b.held; ++k) {
        for (int j = 0; j < k; ++j) rhs[k] -= b.lower(k, j) * beta[j];
        beta[k] = rhs[k] / b.lower(k, k);
      }
      return Vec3(b.q * beta);
    };
    m_particular.segment<3>(3 * b.block) = solve(b.values);
    if (b.pair >= 0) b.pair_response = solve(Vec3::Unit(b.pair));
  }
  for (const Block& b : m_held) {  // partners hold no pair of their own, so their c is final
    if (b.pair < 0) continue;
    const Vec3 partner = m_particular.segment<3>(3 * b.partner);
    m_particular.segment<3>(3 * b.block) += b.pair_response * b.pair_normal.dot(partner);
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
    const Block *here = find(row.block), *there = find(row.partner);
    if ((here && here->pair >= 0) || (there && there->pair >= 0)) return;
    const Block* before = like ? like->find(row.partner) : nullptr;
    const auto left = [&](const Block* b) { return b ? b->rest_of(row.normal, along).norm() : row.normal.norm(); };
    const bool turn = like ? before && before->pair >= 0 : left(here) < 0.5 * left(there);
    if (turn) {
      std::swap(row.block, row.partner);
      row.normal = -row.normal;
    }
  }
  const Block* known = find(row.block);
  if (known && known->held == 3) return;
  along.setZero();
  const Vec3 rest = known ? known->rest_of(row.normal, along) : row.normal;
  const double length = rest.norm();
  if (!(length > dependence * row.normal.norm())) return;
  Block& b = hold(row.block);
  b.q.col(b.held) = rest / length;
  for (int k = 0; k < b.held; ++k) b.lower(b.held, k) = along[k];
  b.lower(b.held, b.held) = length;
  b.tags[b.held] = row.tag;
  b.values[b.held] = row.value;
  if (row.partner >= 0) {
    b.pair = b.held;
    b.partner = row.partner;
    b.pair_normal = row.normal;
  }
  ++b.held;
}

Mat3 Reduction::coupling(const Block& b) const {
  const Mat3 free = find(b.partner) ? find(b.partner)->free() : Mat3(Mat3::Identity());
  return b.pair_response * (b.pair_normal.transpose() * free);
}

// A block's own part in dx and, through a pair row, its partner's.
Reduction::Side Reduction::side(Index block, const Block* held) const {
  Side s;
  s.to[0] = block;
  s.from[0] = held ? held->free() : Mat3(Mat3::Identity());
  if (!held || held->pair < 0) return s;
  s.count = 2;
  s.to[1] = held->partner;
  s.from[1] = coupling(*held);
  return s;
}

void Reduction::reduce(const BlockMatrix& K, double diagonal, BlockMatrix& A) const {
  A.set_zero();
  for (Index j = 0; j < K.blocks(); ++j) {
    const Block* bj = find(j);
    const Index count = Index(K.rows_end(j) - K.rows_begin(j));
    for (Index k = 0; k < count; ++k) {
      const Index i = K.rows_begin(j)[k];
      const Block* bi = find(i);
      const BlockMatrix::Slot slot = K.slot_at(j, k);
      const Mat3 block = K.get(slot);
      if (!bi && !bj) {
        A.add(slot, block);
        continue;
      }
      const Side row = side(i, bi), column = side(j, bj);
      for (int p = 0; p < row.count; ++p) {
        for (int q = 0; q < column.count; ++q) {
          if (i == j && p < q) continue;  // its transpose comes with p > q
          const Mat3 part = row.from[p].transpose() * block * column.from[q];
          if (row.to[p] == column.to[q] && i != j) {
            A.add_at(row.to[p], row.to[p], part + part.transpose());  // K_ij and K_ji
          } else {
            A.add_at(row.to[p], column.to[q], part);
          }
        }
      }
    }
  }
  for (const Block& b : m_held) {
    Vec3 fill = Vec3::Zero();
    for (int k = 0; k < b.held; ++k) fill[k] = diagonal;
    A.add(A.slot_at(b.block, 0), fill.asDiagonal().toDenseMatrix());
  }
}

Eigen::VectorXd Reduction::restrict_force(const Eigen::VectorXd& v) const {
  Eigen::VectorXd y = v;
  for (const Block& b : m_held) {
    if (b.pair < 0) continue;  // v on the block is felt by the partner through the pair row
    y.segment<3>(3 * b.partner) += b.pair_normal * b.pair_response.dot(v.segment<3>(3 * b.block));
  }
  for (const Block& b : m_held) {
    const Vec3 force = y.segment<3>(3 * b.block);
    y.segment<3>(3 * b.block) = b.free().transpose() * force;
  }
  return y;
}

SparseColumns Reduction::restrict_columns(const SparseColumns& forces) const {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index block, const Vec3& force, int column) {
    const Block* b = find(block);
    const Vec3 felt = b ? Vec3(b->free().transpose() * force) : force;
    for (int k = 0; k < 3; ++k) entries.emplace_back(3 * block + k, column, felt[k]);
  };
  for (int c = 0; c < int(forces.cols()); ++c) {
    for (SparseColumns::InnerIterator it(forces, c); it; ++it) {
      const Index block = Index(it.row()) / 3;
      const Vec3 force = it.value() * Vec3::Unit(it.row() % 3);
      add(block, force, c);
      const Block* b = find(block);
      if (b && b->pair >= 0) add(b->partner, b->pair_normal * b->pair_response.dot(force), c);
    }
  }
  SparseColumns result(forces.rows(), forces.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::VectorXd Reduction::expand(const Eigen::VectorXd& y) const {
  Eigen::VectorXd dx = y;
  for (const Block& b : m_held) dx.segment<3>(3 * b.block) = b.free() * Vec3(y.segment<3>(3 * b.block));
  for (const Block& b : m_held) {
    if (b.pair < 0) continue;
    dx.segment<3>(3 * b.block) += b.pair_response * b.pair_normal.dot(dx.segment<3>(3 * b.partner));
  }
  return dx;
}

Indices Reduction::held_blocks() const {
  Indices blocks;
  for (const Block& b : m_held) blocks.push_back(b.block);
  return blocks;
}

std::vector<Reduction::Held> Reduction::held_rows() const {
  std::vector<Held> rows;
  for (const Block& b : m_held) {
    for (int k = 0; k < b.held; ++k) rows.push_back({b.tags[k], b.block});
  }
  return rows;
}

SparseColumns Reduction::released(const Indices& blocks, std::size_t kept,
                                  std::vector<std::size_t>& tags) const {
  std::map<Index, std::vector<const Block*>> followers;   // of a block, through a pair row
  for (const Block& b : m_held) {
    if (b.pair >= 0) followers[b.partner].push_back(&b);
  }
  std::vector<Eigen::Triplet<double>> entries;
  int column = 0;
  const auto add = [&](Index block, const Vec3& motion) {
    for (int k = 0; k < 3; ++k) entries.emplace_back(3 * block + k, column, motion[k]);
  };
  for (Index block : blocks) {
    const Block* b = find(block);
    for (int k = 0; b && k < b->held; ++k) {
      if (b->tags[k] == kept) continue;
      const Vec3 motion = b->q.col(k);
      add(block, motion);
      for (const Block* f : followers[block]) add(f->block, f->pair_response * f->pair_normal.dot(motion));
      tags.push_back(b->tags[k]);
      ++column;
    }
  }
  SparseColumns result(3 * Eigen::Index(m_place.size()), column);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void Reduction::multipliers(const Eigen::VectorXd& unbalanced, std::vector<double>& by_tag) const {
  Eigen::VectorXd force = unbalanced;
  // Blocks with a pair row first: their reaction loads the partner.
  for (int pass = 0; pass < 2; ++pass) {
    for (const Block& b : m_held) {
      if ((b.pair >= 0) != (pass == 0)) continue;
      // sum_k multiplier_k normal_k = -force along the held directions: lower^T m = -q^T force.
      Vec3 rhs = -b.q.transpose() * force.segment<3>(3 * b.block);
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
  for (const Block& b : m_held) rest.segment<3>(3 * b.block) = b.q * Vec3(rest.segment<3>(3 * b.block));
  return rest;
}

}  // namespace brainshift
