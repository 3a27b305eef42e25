// The linearised tissue: the tangent K + sum column row^T, its factor on the motions that one set of
// rows allows, and steps on those that another set allows. What differs between the sets stands in a
// border of the factor, docs/theory.md (26), so that a factor outlives its active set.
#pragma once

#include <optional>
#include <vector>

#include "contact/reduction.hpp"
#include "linear/dense_lu.hpp"
#include "linear/spd_solver.hpp"

namespace brainshift {

class LinearisedTissue {
 public:
  // K and solver must outlive it; both are the owner's to fill. path: forces on points of the tissue, one
  // per column, on blocks.
  LinearisedTissue(const BlockMatrix& K, SpdSolver& solver, SparseColumns path);

  // The terms of K that are not in its pattern; one per column, on blocks. Drops the factor.
  void set_terms(Eigen::MatrixXd columns, Eigen::MatrixXd rows);
  // The solver has factored T^T K T of this reduction.
  void take_factor(const Reduction& factored);
  bool has_terms() const { return m_terms.cols() > 0; }
  bool has_factor() const { return m_factored.has_value(); }
  const Reduction& factored() const { return *m_factored; }

  // Begins an iteration. held: the rows of the factor's set, as they are today; in_force: those of the set
  // to begin with, with their multipliers (by tag).
  void begin(std::vector<NodeRow> held, const std::vector<NodeRow>& in_force,
             const std::vector<double>& multipliers, const Eigen::VectorXd& force);
  // Makes ready for steps that obey the rows of `wanted`. rows: those of `wanted` by tag, `untagged` for
  // the ones that never change. False: the factor does not do, the tangent may not be positive there.
  bool serve(const Reduction& wanted, const std::vector<NodeRow>& rows, std::size_t untagged);

  // Columns of a border of so many unknowns beyond which a new factor costs less.
  static Eigen::Index largest_border(Eigen::Index unknowns);

  // Motion along the path by the force of begin(), and by unit forces along the path.
  const Eigen::VectorXd& free_motion() const { return m_free_path; }
  const Eigen::MatrixXd& compliance() const { return m_compliance; }
  // The step under that force and forces along the path, on blocks.
  Eigen::VectorXd step(const Eigen::VectorXd& along_path) const;

  const SparseColumns& path() const { return m_path; }
  // (K + sum column row^T) dx on these blocks; 0 on all others.
  Eigen::VectorXd times(const Eigen::VectorXd& dx, const Indices& blocks) const;

 private:
  // Columns of the border beside the factor, of one tag: the motion that its row's release gives, and the
  // row. With what they were made of, on blocks.
  struct Place {
    int released = -1, held = -1;
    Eigen::SparseVector<double> motion, pushed, row;   // Z, K Z, N
  };
  struct Pushing {
    NodeRow row;
    double multiplier;
  };
  void find_border(const Reduction& wanted, const std::vector<NodeRow>& rows, std::size_t untagged);
  SparseColumns gather(const std::vector<NodeRow>& rows, const std::vector<char>& taken);
  void take_path();
  void count_in(const std::vector<NodeRow>& rows, const std::vector<double>& multipliers);
  static void push(const NodeRow& row, double multiplier, Eigen::VectorXd& force);
  void take_back();
  void append_missing();
  void collect_columns();
  Eigen::MatrixXd schur() const;
  void act_on_path();
  void solve_border();

  const BlockMatrix& m_K;
  SpdSolver& m_solver;
  SparseColumns m_path;
  Eigen::MatrixXd m_terms, m_term_rows;
  std::optional<Reduction> m_factored;
  Eigen::MatrixXd m_restricted_rows;         // T^T of the terms' rows
  Eigen::MatrixXd m_moved, m_moved_rows;     // A^-1 T^T of the terms

  // Of a factor. Columns of the solver: those of the path, and what any set has needed since.
  SparseColumns m_path_columns;              // T^T of the path
  std::vector<Place> m_places;               // by tag

  // Of an iteration.
  std::optional<Reduction> m_base;
  Eigen::VectorXd m_force;                   // less K c, with the rows counted in
  Eigen::VectorXd m_restricted, m_forward;   // T^T of that, and half of its solution
  std::vector<Pushing> m_pushing;            // the rows counted in
  std::vector<std::size_t> m_loose;          // rows of the factor that are not in force

  // Of the set that is served. Unknowns of the border: released motions, rows, terms.
  SparseColumns m_released;                  // Z, on blocks
  SparseColumns m_rows;                      // N, on blocks
  Eigen::VectorXd m_values;                  // of the rows
  Eigen::VectorXd m_taken_back;              // on blocks: of rows counted in that the set lets go
  Eigen::VectorXd m_given;                   // of each column of the solver, for the same
  std::vector<std::size_t> m_released_tags, m_row_tags;
  std::vector<int> m_columns;                // of the solver, for T^T [K Z, N]
  SparseColumns m_Z, m_KZ, m_N;              // what those columns were made of
  DenseLu m_schur;
  // Border x path: E^T A^-1 P - Z^T P, with the columns and with the rows of the terms.
  Eigen::MatrixXd m_to_path, m_from_path;
  Eigen::MatrixXd m_compliance;
  Eigen::VectorXd m_border, m_free_path;
};

}  // namespace brainshift
