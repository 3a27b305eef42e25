#include "stepper/turned_factor.hpp"

#include "linear/conjugate_gradients.hpp"
#include "tissue/nodal_rotations.hpp"

namespace brainshift {
namespace {

using Vector = Eigen::VectorXd;

// The residual that is left of a step, and the solves that a factor is worth. docs/decisions/speed.md
constexpr double part_left = 0.1;
constexpr int most_iterations = 25;

}  // namespace

TurnedFactor::TurnedFactor(const Mesh& mesh, const Blocks& blocks, const BlockMatrix& K, SpdSolver& solver)
    : m_mesh(mesh), m_blocks(blocks), m_K(K), m_solver(solver) {}

std::vector<Mat3> TurnedFactor::rotations(const Points& u) const {
  const std::vector<Mat3> of_nodes = nodal_rotations(m_mesh, u);
  std::vector<Mat3> of_blocks(std::size_t(m_blocks.count()), Mat3::Identity());
  for (std::size_t i = 0; i < of_nodes.size(); ++i) of_blocks[std::size_t(m_blocks.block_of()[i])] = of_nodes[i];
  return of_blocks;
}

void TurnedFactor::take_factor(const Reduction& factored, const Points& u) {
  m_factored = factored;
  m_at = u;
  m_then.clear();
}

// Blocks that rows hold have axes of their own, and do not turn.
Vector TurnedFactor::solve(const Vector& y) const {
  Eigen::MatrixXd z = y;
  const auto block = [&z](std::size_t i) { return z.col(0).segment<3>(3 * Eigen::Index(i)); };
  for (std::size_t i = 0; i < m_turns.size(); ++i) block(i) = m_turns[i].transpose() * block(i);
  m_solver.solve(z);
  for (std::size_t i = 0; i < m_turns.size(); ++i) block(i) = m_turns[i] * block(i);
  return z;
}

std::optional<Vector> TurnedFactor::step(const std::vector<NodeRow>& rows, const Points& u, const Vector& force) {
  const Reduction reduction(m_blocks.count(), rows, &*m_factored);
  if (m_then.empty()) {
    m_then = rotations(m_at);
    m_solver.round_factor();   // in double precision where it cannot be
  }
  m_turns = rotations(u);
  for (std::size_t i = 0; i < m_turns.size(); ++i) {
    m_turns[i] = reduction.holds(Index(i)) ? Mat3(Mat3::Identity()) : Mat3(m_turns[i] * m_then[i].transpose());
  }
  const auto times = [&](const Vector& y) {
    Vector product;
    m_K.multiply(reduction.expand(y), product);
    return reduction.restrict_force(product);
  };
  Vector product;
  m_K.multiply(reduction.particular(), product);
  const Vector r = reduction.restrict_force(force - product);
  const auto precondition = [this](const Vector& b) { return solve(b); };
  const Vector z = solve(r);
  const double aim = part_left * part_left * r.dot(z);
  Vector y = Vector::Zero(r.size());
  const auto run = conjugate_gradients(times, precondition, r, z, aim, most_iterations, y);
  if (!run.positive || !(run.rho <= aim)) return std::nullopt;
  return reduction.expand(y) + reduction.particular();
}

}  // namespace brainshift
