#include "stepper/linearised_tissue.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

namespace brainshift {
namespace {

// A border beyond these costs more than a new factor: columns per unknown, and in all.
constexpr Eigen::Index part_of_border = 32, columns_of_border = 1000;

bool same(const SparseColumns& a, const SparseColumns& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  return a.size() == 0 || (a - b).squaredNorm() == 0.0;
}

}  // namespace

LinearisedTissue::LinearisedTissue(const BlockMatrix& K, SpdSolver& solver, SparseColumns path)
    : m_K(K), m_solver(solver), m_path(std::move(path)) {}

void LinearisedTissue::set_terms(Eigen::MatrixXd columns, Eigen::MatrixXd rows) {
  m_terms = std::move(columns);
  m_term_rows = std::move(rows);
  m_factored.reset();
}

void LinearisedTissue::take_factor(const Reduction& factored) {
  m_factored = factored;
  m_places.clear();
  m_path_columns.resize(0, 0);
  m_moved.resize(m_terms.rows(), m_terms.cols());
  m_moved_rows.resize(m_terms.rows(), m_terms.cols());
  for (Eigen::Index k = 0; k < m_terms.cols(); ++k) {
    m_moved.col(k) = factored.restrict_force(m_terms.col(k));
    m_moved_rows.col(k) = factored.restrict_force(m_term_rows.col(k));
  }
  m_restricted_rows = m_moved_rows;
  if (m_terms.cols() == 0) return;
  m_solver.solve(m_moved);
  m_solver.solve(m_moved_rows);
}

Eigen::VectorXd LinearisedTissue::times(const Eigen::VectorXd& dx, const Indices& blocks) const {
  Eigen::VectorXd product;
  m_K.multiply(dx, blocks, product);
  const Eigen::VectorXd parts = m_term_rows.transpose() * dx;
  for (const Index i : blocks) product.segment<3>(3 * i) += m_terms.middleRows<3>(3 * i) * parts;
  return product;
}

// Columns outlive the iteration that needed them, and are then of yesterday's rows. They may only weigh what
// vanishes at the balance: so multipliers push with today's rows and leave their change to the columns, and
// a row of the factor that is not in force has nothing to close, or its release would have to undo it.
void LinearisedTissue::begin(std::vector<NodeRow> held, const std::vector<NodeRow>& in_force,
                             const std::vector<double>& multipliers, const Eigen::VectorXd& force) {
  m_loose.clear();
  for (NodeRow& row : held) {
    const auto is_it = [&row](const NodeRow& other) { return other.tag == row.tag; };
    if (std::any_of(in_force.begin(), in_force.end(), is_it)) continue;
    row.value = 0.0;
    m_loose.push_back(row.tag);
  }
  m_base.emplace(m_K.blocks(), held, &*m_factored);
  take_path();
  Eigen::VectorXd moved;
  m_K.multiply(m_base->particular(), moved);
  m_force = force - moved;
  count_in(in_force, multipliers);
  m_restricted = m_base->restrict_force(m_force);
  m_forward = m_solver.forward(m_restricted);
}

void LinearisedTissue::take_path() {
  SparseColumns path = m_base->restrict_columns(m_path);
  const bool many = m_solver.column_count() > path.cols() + largest_border(path.rows());
  if (many || !same(path, m_path_columns)) {
    m_solver.keep(0);
    m_places.clear();
    m_solver.append(path);
  }
  m_path_columns = std::move(path);
}

void LinearisedTissue::push(const NodeRow& row, double multiplier, Eigen::VectorXd& force) {
  force.segment<3>(3 * row.block) += multiplier * row.normal;
  if (row.partner >= 0) force.segment<3>(3 * row.partner) -= multiplier * row.normal;
}

void LinearisedTissue::count_in(const std::vector<NodeRow>& rows, const std::vector<double>& multipliers) {
  m_pushing.clear();
  for (const NodeRow& row : rows) {
    if (row.tag >= m_places.size() || m_places[row.tag].held < 0) continue;
    m_pushing.push_back({row, multipliers[row.tag]});
    push(row, multipliers[row.tag], m_force);
  }
}

// Rows that were counted in and that the set lets go: exactly where that is cheap, else by their columns.
void LinearisedTissue::take_back() {
  m_taken_back.setZero(m_force.size());
  m_given.setZero(m_solver.column_count());
  for (const Pushing& pushing : m_pushing) {
    const auto there = std::find(m_row_tags.begin(), m_row_tags.end(), pushing.row.tag);
    if (there != m_row_tags.end()) continue;
    push(pushing.row, -pushing.multiplier, m_taken_back);
    m_given[m_places[pushing.row.tag].held] -= pushing.multiplier;
  }
}

// A block lets go all of its rows if it loses one; those it keeps come back as rows of the border.
void LinearisedTissue::find_border(const Reduction& wanted, const std::vector<NodeRow>& rows,
                                   std::size_t untagged) {
  std::vector<char> asked(untagged + 1, 0);
  for (const Reduction::Held& row : wanted.held_rows()) asked[row.tag] = 1;
  const std::vector<Reduction::Held> held = m_base->held_rows();
  Indices loose;
  for (const Reduction::Held& row : held) {
    const bool loose_before = std::find(m_loose.begin(), m_loose.end(), row.tag) != m_loose.end();
    if (row.tag != untagged && (!asked[row.tag] || loose_before)) loose.push_back(row.block);
  }
  std::sort(loose.begin(), loose.end());
  loose.erase(std::unique(loose.begin(), loose.end()), loose.end());
  std::vector<char> taken = asked;
  taken[untagged] = 0;
  for (const Reduction::Held& row : held) {   // what the factor holds anyway
    if (!std::binary_search(loose.begin(), loose.end(), row.block)) taken[row.tag] = 0;
  }
  m_released_tags.clear();
  m_released = m_base->released(loose, untagged, m_released_tags);
  m_rows = gather(rows, taken);
}

SparseColumns LinearisedTissue::gather(const std::vector<NodeRow>& rows, const std::vector<char>& taken) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> values;
  m_row_tags.clear();
  for (const NodeRow& row : rows) {
    if (!taken[row.tag]) continue;
    for (int k = 0; k < 3; ++k) {
      entries.emplace_back(3 * row.block + k, int(values.size()), row.normal[k]);
      if (row.partner >= 0) entries.emplace_back(3 * row.partner + k, int(values.size()), -row.normal[k]);
    }
    values.push_back(row.value);
    m_row_tags.push_back(row.tag);
  }
  m_values = Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
  SparseColumns N(m_path.rows(), m_values.size());
  N.setFromTriplets(entries.begin(), entries.end());
  return N;
}

// Columns that no set has needed since the factor was made.
void LinearisedTissue::append_missing() {
  const SparseColumns KZ = m_K.multiply(m_released);
  std::vector<Eigen::Triplet<double>> entries;
  const int before = int(m_solver.column_count());
  int count = 0;
  const auto append = [&](const Eigen::SparseVector<double>& column) {
    for (Eigen::SparseVector<double>::InnerIterator it(column); it; ++it) {
      entries.emplace_back(int(it.index()), count, it.value());
    }
    return before + count++;
  };
  for (std::size_t i = 0; i < m_released_tags.size(); ++i) {
    Place& place = m_places[m_released_tags[i]];
    if (place.released >= 0) continue;
    place.motion = m_released.col(Eigen::Index(i));
    place.pushed = KZ.col(Eigen::Index(i));
    place.released = append(place.pushed);
  }
  for (std::size_t i = 0; i < m_row_tags.size(); ++i) {
    Place& place = m_places[m_row_tags[i]];
    if (place.held >= 0) continue;
    place.row = m_rows.col(Eigen::Index(i));
    place.held = append(place.row);
  }
  if (count == 0) return;
  SparseColumns missing(m_path.rows(), count);
  missing.setFromTriplets(entries.begin(), entries.end());
  m_solver.append(m_base->restrict_columns(missing));
}

Eigen::Index LinearisedTissue::largest_border(Eigen::Index unknowns) {
  return std::min(unknowns / part_of_border, columns_of_border);
}

void LinearisedTissue::collect_columns() {
  m_columns.clear();
  m_Z.resize(m_path.rows(), m_released.cols());
  m_KZ.resize(m_path.rows(), m_released.cols());
  m_N.resize(m_path.rows(), m_rows.cols());
  for (std::size_t i = 0; i < m_released_tags.size(); ++i) {
    const Place& place = m_places[m_released_tags[i]];
    m_columns.push_back(place.released);
    m_Z.col(Eigen::Index(i)) = place.motion;
    m_KZ.col(Eigen::Index(i)) = place.pushed;
  }
  for (std::size_t i = 0; i < m_row_tags.size(); ++i) {
    const Place& place = m_places[m_row_tags[i]];
    m_columns.push_back(place.held);
    m_N.col(Eigen::Index(i)) = place.row;
  }
}

bool LinearisedTissue::serve(const Reduction& wanted, const std::vector<NodeRow>& rows,
                             std::size_t untagged) {
  m_places.resize(untagged + 1);
  find_border(wanted, rows, untagged);
  const auto size = m_released.cols() + m_rows.cols();
  if (size > largest_border(m_path.rows())) return false;
  append_missing();
  collect_columns();
  Eigen::MatrixXd S = schur();
  const auto nz = m_released.cols();
  const bool positive = nz == 0 || Eigen::LLT<Eigen::MatrixXd>(S.topLeftCorner(nz, nz)).info() == Eigen::Success;
  if (!positive || !S.allFinite()) return false;
  m_schur.compute(std::move(S));
  take_back();
  act_on_path();
  solve_border();
  return m_compliance.allFinite() && m_border.allFinite();
}

// S = H - E^T A^-1 E,  E = T^T [K Z, N, terms],  H what the border's unknowns do to each other.
Eigen::MatrixXd LinearisedTissue::schur() const {
  const auto nz = m_Z.cols(), nn = m_N.cols(), sparse = nz + nn, nt = m_terms.cols();
  const Eigen::MatrixXd& M = m_solver.compliance();
  Eigen::MatrixXd S(sparse + nt, sparse + nt);
  for (Eigen::Index c = 0; c < sparse; ++c) {
    for (Eigen::Index r = 0; r < sparse; ++r) S(r, c) = -M(m_columns[std::size_t(r)], m_columns[std::size_t(c)]);
  }
  const Eigen::MatrixXd coupled = SparseColumns(m_Z.transpose() * m_N);
  S.topLeftCorner(nz, nz) += Eigen::MatrixXd(SparseColumns(m_Z.transpose() * m_KZ));
  S.block(0, nz, nz, nn) += coupled;
  S.block(nz, 0, nn, nz) += coupled.transpose();
  const auto restricted = [&](const Eigen::MatrixXd& moved) -> Eigen::MatrixXd {
    Eigen::MatrixXd result(sparse, nt);
    for (Eigen::Index k = 0; k < nt; ++k) {
      const Eigen::VectorXd dx = m_factored->expand(moved.col(k));   // E^T y = [K Z, N]^T T y
      result.col(k).head(nz) = m_KZ.transpose() * dx;
      result.col(k).tail(nn) = m_N.transpose() * dx;
    }
    return result;
  };
  S.topRightCorner(sparse, nt) = -restricted(m_moved);
  S.bottomLeftCorner(nt, sparse) = -restricted(m_moved_rows).transpose();
  S.topRightCorner(nz, nt) += m_Z.transpose() * m_terms;
  S.bottomLeftCorner(nt, nz) += (m_Z.transpose() * m_term_rows).transpose();
  S.bottomRightCorner(nt, nt) =
      -Eigen::MatrixXd::Identity(nt, nt) - m_restricted_rows.transpose() * m_moved;
  return S;
}

// How border and path act on each other, and the path's compliance with the border in place.
void LinearisedTissue::act_on_path() {
  const auto nz = m_released.cols(), sparse = Eigen::Index(m_columns.size()), nt = m_terms.cols();
  const auto np = m_path.cols();
  const Eigen::MatrixXd& M = m_solver.compliance();
  m_compliance = M.topLeftCorner(np, np);
  m_to_path.resize(sparse + nt, np);
  for (Eigen::Index r = 0; r < sparse; ++r) m_to_path.row(r) = M.row(m_columns[std::size_t(r)]).head(np);
  m_to_path.topRows(nz) -= Eigen::MatrixXd(SparseColumns(m_released.transpose() * m_path));
  m_from_path = m_to_path;
  m_to_path.bottomRows(nt) = (m_path_columns.transpose() * m_moved).transpose();
  m_from_path.bottomRows(nt) = (m_path_columns.transpose() * m_moved_rows).transpose();
  if (np > 0 && sparse + nt > 0) m_compliance += m_to_path.transpose() * m_schur.solve(m_from_path);
}

void LinearisedTissue::solve_border() {
  const auto nz = m_released.cols(), nn = m_rows.cols(), nt = m_terms.cols();
  const Eigen::VectorXd& c = m_base->particular();
  const Eigen::VectorXd moved = m_solver.project(m_forward) + m_solver.compliance() * m_given;
  Eigen::VectorXd right(nz + nn + nt);
  right << m_released.transpose() * (m_force + m_taken_back), m_values - m_rows.transpose() * c,
      -(m_term_rows.transpose() * c) -
          m_moved_rows.transpose() * (m_restricted + m_base->restrict_force(m_taken_back));
  for (Eigen::Index i = 0; i < nz + nn; ++i) right[i] -= moved[m_columns[std::size_t(i)]];
  m_border = m_schur.solve(right);
  m_free_path = moved.head(m_path.cols()) + m_path.transpose() * c - m_to_path.transpose() * m_border;
}

Eigen::VectorXd LinearisedTissue::step(const Eigen::VectorXd& along_path) const {
  const auto nz = m_released.cols(), sparse = Eigen::Index(m_columns.size()), nt = m_terms.cols();
  Eigen::VectorXd border = m_border, columns = m_given;
  if (along_path.size() > 0) {
    border -= m_schur.solve(m_from_path * along_path).col(0);
    columns.head(along_path.size()) += along_path;
  }
  for (Eigen::Index i = 0; i < sparse; ++i) columns[m_columns[std::size_t(i)]] -= border[i];
  Eigen::VectorXd y = m_solver.backward(m_forward, columns);
  if (nt > 0) y -= m_moved * border.tail(nt);
  Eigen::VectorXd dx = m_base->expand(y) + m_base->particular();
  if (nz > 0) dx += m_released * border.head(nz);
  return dx;
}

}  // namespace brainshift
