// Whether a balance that was found is one that the tissue would keep.
#include "stepper/newton.hpp"
#include "stepper/stopwatch.hpp"

namespace brainshift {

// The last tangent that was factored belongs to an iterate next to the state. Where it was not positive
// definite that may have been the iterate's fault: the one at the state decides. One that was turned is far away, and
// conjugate gradients look at few directions.
Definiteness Newton::examine_tangent() {
  if (!m_linearised || !m_linearised->has_factor() || m_far_from_factor) return Definiteness::not_examined;
  if (!m_lost_stability) return Definiteness::positive_definite;
  m_definite = false;   // the tangent as it is, with no part made positive
  assemble();
  Stopwatch watch(m_report.seconds_factor);
  Reduction(m_eq.blocks().count(), rows_of(m_active))
      .reduce(m_cache.stiffness, m_cache.stiffness.mean_diagonal(), m_cache.reduced);
  ++m_report.factorisations;
  return m_cache.solver->factorise(m_cache.reduced) ? Definiteness::positive_definite : Definiteness::indefinite;
}

}  // namespace brainshift
