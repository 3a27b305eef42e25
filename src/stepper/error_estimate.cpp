#include "stepper/error_estimate.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include <Eigen/LU>

#include "brainshift/error.hpp"
#include "linear/spd_solver.hpp"
#include "mesh/edge_nodes.hpp"

namespace brainshift {
namespace {

using Vector = Eigen::VectorXd;

// The ends of the edge on which each node of a quadratic mesh lies, both the node itself at corners.
struct Ends {
  std::vector<std::pair<Index, Index>> of;
  explicit Ends(const Mesh& linear) {
    for (Index i = 0; i < linear.node_count(); ++i) of.emplace_back(i, i);
    for (const auto& edge : edges_of(linear.tets())) of.push_back(edge);
  }
  Points interpolated(const Points& corners) const {
    Points all(Eigen::Index(of.size()), 3);
    for (std::size_t i = 0; i < of.size(); ++i) {
      all.row(Eigen::Index(i)) = 0.5 * (corners.row(of[i].first) + corners.row(of[i].second));
    }
    return all;
  }
  Points gathered(const Points& all, Index corner_count) const {  // its transpose
    Points corners = Points::Zero(corner_count, 3);
    for (std::size_t i = 0; i < of.size(); ++i) {
      corners.row(of[i].first) += 0.5 * all.row(Eigen::Index(i));
      corners.row(of[i].second) += 0.5 * all.row(Eigen::Index(i));
    }
    return corners;
  }
};

// Rows of fixed nodes and of the contacts with a mark.
Reduction held(const Equilibrium& eq, const Points& u, const Forces& forces,
               const std::vector<char>& closed) {
  std::vector<NodeRow> rows = eq.fixed_rows();
  for (NodeRow& row : rows) row.value = -row.normal.dot(u.row(Eigen::Index(row.tag)).transpose());
  for (int pass = 0; pass < 2; ++pass) {  // rows of one node first, then pairs
    for (std::size_t r = 0; r < closed.size(); ++r) {
      const ContactRow& row = eq.contacts().row(r);
      if (!closed[r] || (row.partner >= 0) != (pass == 1)) continue;
      rows.push_back({row.node, row.partner, forces.gaps[r].normal, -forces.gaps[r].gap, r});
    }
  }
  return Reduction(eq.blocks().count(), rows);
}

// The tangent on what the rows leave free, with the slopes of the fluid's heads.
class Tangent {
 public:
  Tangent(const Equilibrium& eq, const Points& u, const Forces& forces,
          const std::vector<double>& multipliers, const std::vector<char>& closed)
      : m_reduction(held(eq, u, forces, closed)), m_full(eq.blocks().make_matrix()) {
    eq.tangent(u, forces, multipliers, false, m_full);
    m_reduced = m_full;
    m_reduction.reduce(m_full, m_full.mean_diagonal(), m_reduced);
    for (const RankOne& term : eq.head_terms(u, forces)) {
      m_columns.push_back(eq.blocks().gather(term.column));
      m_rows.push_back(eq.blocks().gather(term.row));
    }
  }
  const Reduction& reduction() const { return m_reduction; }
  const BlockMatrix& reduced() const { return m_reduced; }

  // What a load leaves out of balance once the rows have their values.
  Vector right_side(const Vector& load) const {
    const Vector& c = m_reduction.particular();
    Vector product;
    m_full.multiply(c, product);
    product += head_terms(c);
    return m_reduction.restrict_force(load - product);
  }
  Vector times(const Vector& y) const {
    Vector product;
    m_reduced.multiply(y, product);
    if (m_columns.empty()) return product;
    return product + m_reduction.restrict_force(head_terms(m_reduction.expand(y)));
  }

 private:
  // Symmetric part; the other one is as small as the difference of the wetted and the body's faces.
  Vector head_terms(const Vector& dx) const {
    Vector sum = Vector::Zero(dx.size());
    for (std::size_t k = 0; k < m_columns.size(); ++k) {
      sum += 0.5 * (m_columns[k] * m_rows[k].dot(dx) + m_rows[k] * m_columns[k].dot(dx));
    }
    return sum;
  }

  Reduction m_reduction;
  BlockMatrix m_full, m_reduced;
  std::vector<Vector> m_columns, m_rows;
};

class TwoLevels {
 public:
  TwoLevels(const Equilibrium& coarse, const Tangent& coarse_tangent, const Equilibrium& fine,
            const Tangent& fine_tangent, const Ends& ends)
      : m_coarse(coarse),
        m_fine(fine),
        m_coarse_tangent(coarse_tangent),
        m_fine_tangent(fine_tangent),
        m_ends(ends),
        m_solver(make_spd_solver()) {
    m_solver->analyse(coarse_tangent.reduced());
    if (!m_solver->factorise(coarse_tangent.reduced())) {
      throw Error(ErrorCode::linear_solver,
                  "the error estimate needs a stable state: the tangent of the linear tets is not "
                  "positive definite");
    }
    const BlockMatrix& A = fine_tangent.reduced();
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
    Points nodal = Points::Zero(m_fine.mesh().node_count(), 3);
    spread(m_fine, m_fine_tangent.reduction().expand(r), nodal);
    const Points corners = m_ends.gathered(nodal, m_coarse.mesh().node_count());
    const Reduction& reduction = m_coarse_tangent.reduction();
    Eigen::MatrixXd y = reduction.restrict_force(m_coarse.blocks().gather(corners));
    m_solver->solve(y);
    Points moved = Points::Zero(m_coarse.mesh().node_count(), 3);
    m_coarse.blocks().scatter_add(reduction.expand(y), 1.0, moved);
    const Points all = m_ends.interpolated(moved);
    z += m_fine_tangent.reduction().restrict_force(mean_of_ties(m_fine, all));
    return z;
  }

 private:
  // Of tied nodes the first stands for the block; transposes of each other.
  static void spread(const Equilibrium& eq, const Vector& blocks, Points& nodal) {
    std::vector<char> seen(std::size_t(eq.blocks().count()), 0);
    for (Index i = 0; i < eq.mesh().node_count(); ++i) {
      const Index b = eq.blocks().block_of()[std::size_t(i)];
      if (seen[std::size_t(b)]++) continue;
      nodal.row(i) = blocks.segment<3>(3 * b).transpose();
    }
  }
  static Vector mean_of_ties(const Equilibrium& eq, const Points& nodal) {
    return eq.blocks().gather_motion(nodal);
  }

  const Equilibrium &m_coarse, &m_fine;
  const Tangent &m_coarse_tangent, &m_fine_tangent;
  const Ends& m_ends;
  std::unique_ptr<SpdSolver> m_solver;
  std::vector<Mat3> m_inverse_diagonal;
};

struct Solution {
  Vector y;
  int iterations = 0;
  double residual = 0.0;
};

// Preconditioned conjugate gradients to two digits more than the estimate needs.
Solution conjugate_gradients(const Tangent& A, const TwoLevels& precondition, const Vector& b) {
  constexpr double tolerance = 1e-4;
  constexpr int most = 500;
  Solution s{Vector::Zero(b.size())};
  Vector r = b, z = precondition(r), p = z;
  double rho = r.dot(z);
  const double first = rho;
  while (rho > tolerance * tolerance * first) {
    const Vector Ap = A.times(p);
    const double curvature = p.dot(Ap);
    if (!(curvature > 0.0)) {
      throw Error(ErrorCode::linear_solver,
                  "the error estimate needs a stable state: the tangent of the quadratic tets is "
                  "not positive definite");
    }
    const double part = rho / curvature;
    s.y += part * p;
    r -= part * Ap;
    z = precondition(r);
    const double next = r.dot(z);
    p = z + next / rho * p;
    rho = next;
    if (++s.iterations == most) {
      throw Error(ErrorCode::linear_solver,
                  "the error estimate did not converge in " + std::to_string(most) + " iterations");
    }
  }
  s.residual = first > 0.0 ? std::sqrt(rho / first) : 0.0;
  return s;
}

// Contacts of the fine mesh on edges between two nodes whose contacts carry a force.
std::vector<char> closed_contacts(const LinearState& state, const Equilibrium& fine,
                                  const Ends& ends) {
  std::map<ConstraintId, std::vector<char>> pressed;  // by group, per corner
  const ContactRows& coarse = state.equilibrium.contacts();
  for (std::size_t r = 0; r < coarse.size(); ++r) {
    auto& marks = pressed[coarse.group_of(r).id];
    marks.resize(std::size_t(state.u.rows()), 0);
    if (state.multipliers[r] > 0.0) marks[std::size_t(coarse.mesh_node(r))] = 1;
  }
  std::vector<char> closed(fine.contacts().size(), 0);
  for (std::size_t r = 0; r < closed.size(); ++r) {
    const auto marks = pressed.find(fine.contacts().group_of(r).id);
    if (marks == pressed.end()) continue;
    const auto [a, b] = ends.of[std::size_t(fine.contacts().mesh_node(r))];
    closed[r] = marks->second[std::size_t(a)] && marks->second[std::size_t(b)];
  }
  return closed;
}

}  // namespace

QuadraticCorrection quadratic_correction(const LinearState& state, const Equilibrium& fine) {
  const Equilibrium& coarse = state.equilibrium;
  const Ends ends(coarse.mesh());
  std::vector<char> pressed;
  for (double multiplier : state.multipliers) pressed.push_back(multiplier > 0.0);
  const Tangent coarse_tangent(coarse, state.u, coarse.forces(state.u), state.multipliers, pressed);

  const Points u = ends.interpolated(state.u);
  const Forces forces = fine.forces(u);
  Points load = forces.external - forces.internal;
  if (!state.devices.empty()) {  // their forces stay what they are
    const Coupling coupling(fine.mesh(), state.devices, u);
    const std::vector<DeviceMotion> motions = coupling.motions();
    DeviceVectors unused;
    for (const InsertedDevice& d : state.devices) {
      unused.push_back(Vector::Zero(d.beam.dof_count()));
    }
    coupling.add_forces(coupling.rows(u, motions), motions, load, unused);
  }
  const std::vector<double> no_curvature(fine.contacts().size(), 0.0);
  const Tangent tangent(fine, u, forces, no_curvature, closed_contacts(state, fine, ends));
  const TwoLevels precondition(coarse, coarse_tangent, fine, tangent, ends);
  const Solution solution =
      conjugate_gradients(tangent, precondition, tangent.right_side(fine.blocks().gather(load)));
  const Vector moved = tangent.reduction().expand(solution.y) + tangent.reduction().particular();
  QuadraticCorrection result{fine.mesh(), Points::Zero(fine.mesh().node_count(), 3),
                             solution.iterations, solution.residual};
  fine.blocks().scatter_add(moved, 1.0, result.w);
  return result;
}

}  // namespace brainshift
