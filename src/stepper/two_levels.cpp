#include "stepper/two_levels.hpp"

#include <cmath>
#include <string>

#include <Eigen/LU>

#include "brainshift/error.hpp"
#include "linear/conjugate_gradients.hpp"
#include "mesh/edge_nodes.hpp"

namespace brainshift {
namespace {

using Vector = Eigen::VectorXd;

// Rows of fixed nodes, tagged behind the contacts, and of the contacts with a mark.
Reduction held(const Equilibrium& eq, const Points& u, const Forces& forces,
               const std::vector<char>& closed) {
  std::vector<NodeRow> rows = eq.fixed_rows();
  for (NodeRow& row : rows) {
    row.value = -row.normal.dot(u.row(Eigen::Index(row.tag)).transpose());
    row.tag = closed.size();
  }
  for (int pass = 0; pass < 2; ++pass) {  // rows of one node first, then pairs
    for (std::size_t r = 0; r < closed.size(); ++r) {
      const ContactRow& row = eq.contacts().row(r);
      if (!closed[r] || (row.partner >= 0) != (pass == 1)) continue;
      rows.push_back({row.node, row.partner, forces.gaps[r].normal, -forces.gaps[r].gap, r});
    }
  }
  return Reduction(eq.blocks().count(), rows);
}

// Of tied nodes the first stands for the block: the transpose of a block's mean motion.
Points on_nodes(const Equilibrium& eq, const Vector& blocks) {
  Points nodal = Points::Zero(eq.mesh().node_count(), 3);
  std::vector<char> seen(std::size_t(eq.blocks().count()), 0);
  for (Index i = 0; i < eq.mesh().node_count(); ++i) {
    const Index b = eq.blocks().block_of()[std::size_t(i)];
    if (seen[std::size_t(b)]++) continue;
    nodal.row(i) = blocks.segment<3>(3 * b).transpose();
  }
  return nodal;
}

class Preconditioner {
 public:
  Preconditioner(const Equilibrium& eq, const Tangent& tangent, const CoarseLevel& coarse)
      : m_eq(eq), m_tangent(tangent), m_coarse(coarse) {
    const BlockMatrix& A = tangent.reduced();
    for (Index j = 0; j < A.blocks(); ++j) {
      Mat3 block = A.get(A.slot_at(j, 0));
      block.triangularView<Eigen::StrictlyUpper>() = block.transpose();
      m_inverse_diagonal.push_back(block.inverse());
    }
  }
  Vector operator()(const Vector& r) const {
    Vector z(r.size());
    for (std::size_t j = 0; j < m_inverse_diagonal.size(); ++j) {
      const auto at = 3 * Eigen::Index(j);
      z.segment<3>(at) = m_inverse_diagonal[j] * r.segment<3>(at);
    }
    const Reduction& reduction = m_tangent.reduction();
    const Points moved = m_coarse.solve(on_nodes(m_eq, reduction.expand(r)));
    return z + reduction.restrict_force(m_eq.blocks().gather_motion(moved));
  }

 private:
  const Equilibrium& m_eq;
  const Tangent& m_tangent;
  const CoarseLevel& m_coarse;
  std::vector<Mat3> m_inverse_diagonal;
};

}  // namespace

EdgeEnds::EdgeEnds(const Mesh& linear) {
  for (Index i = 0; i < linear.node_count(); ++i) m_of.emplace_back(i, i);
  for (const auto& edge : edges_of(linear.tets())) m_of.push_back(edge);
}

Points EdgeEnds::interpolated(const Points& corners) const {
  Points all(Eigen::Index(m_of.size()), 3);
  for (std::size_t i = 0; i < m_of.size(); ++i) {
    all.row(Eigen::Index(i)) = 0.5 * (corners.row(m_of[i].first) + corners.row(m_of[i].second));
  }
  return all;
}

Points EdgeEnds::gathered(const Points& all, Index corner_count) const {
  Points corners = Points::Zero(corner_count, 3);
  for (std::size_t i = 0; i < m_of.size(); ++i) {
    corners.row(m_of[i].first) += 0.5 * all.row(Eigen::Index(i));
    corners.row(m_of[i].second) += 0.5 * all.row(Eigen::Index(i));
  }
  return corners;
}

Tangent::Tangent(const Equilibrium& eq, const Points& u, const Forces& forces,
                 const std::vector<double>& multipliers)
    : m_eq(eq), m_u(u), m_forces(forces), m_full(eq.blocks().make_matrix()), m_reduced(m_full) {
  eq.tangent(u, forces, multipliers, false, m_full);
  for (const RankOne& term : eq.head_terms(u, forces)) {
    m_columns.push_back(eq.blocks().gather(term.column));
    m_rows.push_back(eq.blocks().gather(term.row));
  }
}

void Tangent::close(const std::vector<char>& contacts) {
  m_reduction.emplace(held(m_eq, m_u, m_forces, contacts));
  m_reduction->reduce(m_full, m_full.mean_diagonal(), m_reduced);
}

Vector Tangent::right_side(const Vector& load) const {
  const Vector& c = m_reduction->particular();
  Vector product;
  m_full.multiply(c, product);
  product += head_terms(c);
  return m_reduction->restrict_force(load - product);
}

Vector Tangent::times(const Vector& y) const {
  Vector product;
  m_reduced.multiply(y, product);
  if (m_columns.empty()) return product;
  return product + m_reduction->restrict_force(head_terms(m_reduction->expand(y)));
}

std::vector<double> Tangent::multipliers(const Vector& load, const Vector& dx) const {
  Vector product;
  m_full.multiply(dx, product);
  std::vector<double> found(m_eq.contacts().size() + 1, 0.0);  // the last one: of the fixed rows
  m_reduction->multipliers(load - product - head_terms(dx), found);
  found.pop_back();
  return found;
}

// Symmetric part; the other one is as small as the difference of the wetted and the body's faces.
Vector Tangent::head_terms(const Vector& dx) const {
  Vector sum = Vector::Zero(dx.size());
  for (std::size_t k = 0; k < m_columns.size(); ++k) {
    sum += 0.5 * (m_columns[k] * m_rows[k].dot(dx) + m_rows[k] * m_columns[k].dot(dx));
  }
  return sum;
}

CoarseLevel::CoarseLevel(const Equilibrium& eq, const Tangent& tangent, const EdgeEnds& ends)
    : m_eq(eq), m_tangent(tangent), m_ends(ends), m_solver(make_spd_solver()) {
  m_solver->analyse(tangent.reduced());
  if (m_solver->factorise(tangent.reduced())) return;
  throw Error(
      ErrorCode::linear_solver,
      "the error estimate needs a stable state: the tangent of the linear tets is not positive "
      "definite");
}

Points CoarseLevel::solve(const Points& forces) const {
  const Index corners = m_eq.mesh().node_count();
  const Reduction& reduction = m_tangent.reduction();
  Eigen::MatrixXd y =
      reduction.restrict_force(m_eq.blocks().gather(m_ends.gathered(forces, corners)));
  m_solver->solve(y);
  Points moved = Points::Zero(corners, 3);
  m_eq.blocks().scatter_add(reduction.expand(y), 1.0, moved);
  return m_ends.interpolated(moved);
}

TwoLevelSolution solve_two_levels(const Equilibrium& eq, const Tangent& A,
                                  const CoarseLevel& coarse, const Vector& load, double tolerance,
                                  TwoLevelSolution s) {
  constexpr int most = 500;
  const Preconditioner precondition(eq, A, coarse);
  Vector r = A.right_side(load), z = precondition(r);
  const double whole = r.dot(z);
  if (s.y.size() == 0) {
    s.y = Vector::Zero(r.size());
  } else {
    r -= A.times(s.y);
    z = precondition(r);
  }
  const auto run = conjugate_gradients([&A](const Vector& p) { return A.times(p); }, precondition, std::move(r),
                                       std::move(z), tolerance * tolerance * whole, most, s.y);
  if (!run.positive) {
    throw Error(ErrorCode::linear_solver,
                "the error estimate needs a stable state: the tangent of the quadratic tets is "
                "not positive definite");
  }
  if (run.rho > tolerance * tolerance * whole) {
    throw Error(ErrorCode::linear_solver,
                "the error estimate did not converge in " + std::to_string(most) + " iterations");
  }
  s.iterations = run.iterations;
  s.dx = A.reduction().expand(s.y) + A.reduction().particular();
  s.residual = whole > 0.0 ? std::sqrt(run.rho / whole) : 0.0;
  return s;
}

}  // namespace brainshift
