#include "stepper/error_estimate.hpp"

#include <map>
#include <utility>

#include "stepper/two_levels.hpp"

namespace brainshift {
namespace {

using Vector = Eigen::VectorXd;

// Of the conjugate gradients: for the first changes of the contacts, which are many, and then, two digits
// more than the estimate needs and enough that single contacts do not come and go.
constexpr double first_tolerance = 1e-2, last_tolerance = 1e-4;
constexpr int rough_changes = 2, most_changes = 10;

// Contacts of the fine mesh on edges between two nodes whose contacts carry a force.
std::vector<char> closed_contacts(const LinearState& state, const Equilibrium& fine,
                                  const EdgeEnds& ends) {
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
    const auto [a, b] = ends.of(fine.contacts().mesh_node(r));
    closed[r] = marks->second[std::size_t(a)] && marks->second[std::size_t(b)];
  }
  return closed;
}

// External minus internal forces, with what devices do to the tissue: that stays what it is.
Points unbalanced(const LinearState& state, const Equilibrium& fine, const Points& u,
                  const Forces& forces) {
  Points load = forces.external - forces.internal;
  if (state.devices.empty()) return load;
  const Coupling coupling(fine.mesh(), state.devices, u);
  const std::vector<DeviceMotion> motions = coupling.motions();
  DeviceVectors unused;
  for (const InsertedDevice& d : state.devices) {
    unused.push_back(Vector::Zero(d.beam.dof_count()));
  }
  coupling.add_forces(coupling.rows(u, motions), motions, load, unused);
  return load;
}

// Closes the contacts that a motion of the blocks would open to the wrong side, opens those that pull.
bool improve(const Equilibrium& eq, const Forces& forces, const Vector& dx,
             const std::vector<double>& multipliers, std::vector<char>& closed) {
  const double slack = 1e-12 * eq.mesh().diameter();
  bool changed = false;
  for (std::size_t r = 0; r < closed.size(); ++r) {
    const ContactRow& row = eq.contacts().row(r);
    const Vec3& normal = forces.gaps[r].normal;
    double gap = forces.gaps[r].gap + normal.dot(dx.segment<3>(3 * row.node));
    if (row.partner >= 0) gap -= normal.dot(dx.segment<3>(3 * row.partner));
    const char next = closed[r] ? multipliers[r] >= 0.0 : gap < -slack;
    changed = changed || next != closed[r];
    closed[r] = next;
  }
  return changed;
}

// The step, with the contacts that belong to it (primal-dual active sets).
TwoLevelSolution step_with_contacts(const Equilibrium& fine, const Forces& forces,
                                    const Vector& load, const CoarseLevel& level, Tangent& tangent,
                                    std::vector<char> closed) {
  TwoLevelSolution solution;
  int iterations = 0;
  double tolerance = first_tolerance;
  tangent.close(closed);
  for (int change = 1;; ++change) {
    solution = solve_two_levels(fine, tangent, level, load, tolerance, std::move(solution));
    iterations += solution.iterations;
    const std::vector<double> multipliers = tangent.multipliers(load, solution.dx);
    const bool changed = improve(fine, forces, solution.dx, multipliers, closed);
    if (tolerance == last_tolerance && (!changed || change >= most_changes)) break;
    if (!changed || change >= rough_changes) tolerance = last_tolerance;
    if (!changed) continue;  // with more digits
    tangent.close(closed);
    solution = {};
  }
  solution.iterations = iterations;
  return solution;
}

}  // namespace

QuadraticCorrection quadratic_correction(const LinearState& state, const Equilibrium& fine) {
  const Equilibrium& coarse = state.equilibrium;
  const EdgeEnds ends(coarse.mesh());
  std::vector<char> pressed;
  for (double multiplier : state.multipliers) pressed.push_back(multiplier > 0.0);
  const Forces coarse_forces = coarse.forces(state.u);
  Tangent coarse_tangent(coarse, state.u, coarse_forces, state.multipliers);
  coarse_tangent.close(pressed);
  const CoarseLevel level(coarse, coarse_tangent, ends);

  const Points u = ends.interpolated(state.u);
  const Forces forces = fine.forces(u);
  const Vector load = fine.blocks().gather(unbalanced(state, fine, u, forces));
  Tangent tangent(fine, u, forces, std::vector<double>(fine.contacts().size(), 0.0));
  const TwoLevelSolution solution =
      step_with_contacts(fine, forces, load, level, tangent, closed_contacts(state, fine, ends));
  QuadraticCorrection result{fine.mesh(), Points::Zero(fine.mesh().node_count(), 3),
                             solution.iterations, solution.residual};
  fine.blocks().scatter_add(solution.dx, 1.0, result.w);
  return result;
}

}  // namespace brainshift
