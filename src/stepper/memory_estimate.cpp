// What a solve will take, from the patterns of its matrices.
#include <algorithm>
#include <functional>
#include <numeric>

#include "stepper/stepper_impl.hpp"

namespace brainshift {
namespace {

using Bytes64 = std::int64_t;
constexpr Bytes64 number = sizeof(double), index = sizeof(Index);

Bytes64 dense(Eigen::Index rows, Eigen::Index columns) { return number * rows * columns; }

Bytes64 bytes_of(const BlockMatrix& m) {
  return Bytes64(m.values().size()) * (number + index) + index * m.block_nonzeros();
}

// The columns that contacts may put beside a factor: K times the motion a row's release gives, which
// reaches the neighbours of its block.
SparseColumns contact_columns(const ContactRows& contacts, const BlockMatrix& K) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r < contacts.size(); ++r) {
    const ContactRow& row = contacts.row(r);
    for (const Index block : {row.node, row.partner}) {
      if (block >= 0) entries.emplace_back(3 * int(block), int(r), 1.0);
    }
  }
  SparseColumns motions(3 * K.blocks(), Eigen::Index(contacts.size()));
  motions.setFromTriplets(entries.begin(), entries.end());
  return K.multiply(motions);
}

// Sum of the `count` largest.
Bytes64 sum_of_largest(std::vector<std::int64_t> values, Eigen::Index count) {
  const auto middle = values.begin() + count;
  std::nth_element(values.begin(), middle, values.end(), std::greater<>());
  return std::accumulate(values.begin(), middle, Bytes64(0));
}

// Numbers of the problems that come after the factor.
struct Columns {
  Eigen::Index path, contacts;   // beside the factor
  Eigen::Index rows;             // of coupling
};

// Work on those: the border's Schur complement and what it does to the path; the rows' problem with the
// turns of their ties, on tissue and on each device.
Bytes64 work_of(const Columns& n, const std::vector<InsertedDevice>& devices) {
  const Eigen::Index all = 2 * n.rows;
  Bytes64 work = 2 * dense(n.contacts, n.contacts) + 3 * dense(n.contacts, n.path) + 2 * dense(n.path, n.path) +
                 dense(all, all) + 3 * dense(n.rows, n.rows);
  for (const InsertedDevice& d : devices) work += 3 * dense(d.beam.dof_count(), all);
  return work;
}

// What a solve has of each node and of each tet beside the matrices, found by measurement: copies of the
// equilibrium, states and forces, reductions; forces of the elements. tests/memory
constexpr Bytes64 per_node = 1200, per_corner_of_tet = 40, small_change = Bytes64(1) << 20;

}  // namespace

MemoryEstimate Stepper::Impl::memory_estimate() {
  Equilibrium trial = m_equilibrium;
  configure(trial, m_state.wanted);
  FactorCache own;   // a solve that is begun needs the one there is
  FactorCache& cache = phase() == StepPhase::idle ? m_cache : own;
  cache.prepare(trial.blocks_pointer(), m_options.threads);
  const SpdSolver& solver = *cache.solver;
  const Coupling coupling(m_mesh, m_state.devices, m_state.u);
  const SparseColumns path = coupling.path_columns(trial.blocks());
  const auto rows = Eigen::Index(coupling.rows(m_state.u, coupling.motions()).size());
  const Eigen::Index unknowns = path.rows();
  const auto loose = std::min<Eigen::Index>(LinearisedTissue::largest_border(unknowns),
                                            Eigen::Index(trial.contacts().size()));
  const Columns columns{path.cols(), loose, rows};
  const FactorSize size = solver.size();

  MemoryEstimate estimate;
  estimate.factor = size.factor;
  const std::vector<std::int64_t> of_contacts = solver.reach(contact_columns(trial.contacts(), cache.stiffness));
  estimate.border = number * (sum_of_largest(solver.reach(path), path.cols()) + sum_of_largest(of_contacts, loose));
  estimate.compliance = dense(path.cols() + loose, path.cols() + loose) + dense(rows, rows);
  // What the factorisation works with is gone when the border comes.
  const Bytes64 after = estimate.border + estimate.compliance + work_of(columns, m_state.devices);
  const int corners = m_mesh.is_quadratic() ? 10 : 4;
  Bytes64 kept = bytes_of(cache.stiffness) + bytes_of(cache.reduced) + per_node * m_mesh.node_count() +
                 per_corner_of_tet * corners * m_mesh.tet_count() + small_change;
  // Terms of the fluid's heads (their equations: src/fluid/hydrostatics.hpp) and what they move.
  if (trial.fluid()) kept += 8 * dense(unknowns, m_state.wanted.csf->compartment_count());
  estimate.total = size.factor + kept + std::max(size.work, after);
  estimate.rest = estimate.total - estimate.factor - estimate.border - estimate.compliance;
  return estimate;
}

MemoryEstimate Stepper::memory_estimate() const { return m_impl->memory_estimate(); }

}  // namespace brainshift
