#include "beam/statics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Dense>

#include "beam/rotation.hpp"
#include "brainshift/error.hpp"

namespace brainshift {
namespace {

class StaticNewton {
 public:
  StaticNewton(const Beam& beam, const BeamLoad& load)
      : m_beam(beam), m_fixed(load.fixed), m_free(Eigen::VectorXd::Ones(beam.dof_count())) {
    for (const Index dof : m_fixed) m_free[dof] = 0.0;
    for (Index i = 0; i < beam.node_count(); ++i) {
      const Vec3 moment =
          m_free.segment<3>(6 * i + 3).cwiseProduct(load.force.segment<3>(6 * i + 3));
      if (moment.squaredNorm() > 0.0) m_moments.push_back(i);
    }
  }

  enum class Outcome { converged, not_converged, saddle };

  // Full steps with element forces as unknowns: fast, and blind to the kind of equilibrium it finds.
  // `state` is left alone unless it converges.
  Outcome mixed(const Eigen::VectorXd& force, BeamState& state, const BeamStaticsOptions& options,
                BeamStaticsReport& report) {
    BeamState next = state;
    const Outcome outcome = iterate(Method::mixed, force, next, options, report);
    if (outcome == Outcome::converged) state = std::move(next);
    return outcome;
  }

  // Exact tangent and energy line search: sure, and slow. Only without moments.
  Outcome descent(const Eigen::VectorXd& force, BeamState& state, const BeamStaticsOptions& options,
                  BeamStaticsReport& report) {
    if (!m_moments.empty()) return Outcome::not_converged;
    BeamState next = state;
    const Outcome outcome = iterate(Method::descent, force, next, options, report);
    if (outcome == Outcome::converged) state = std::move(next);
    return outcome;
  }

 private:
  enum class Method { mixed, descent };

  Outcome iterate(Method method, const Eigen::VectorXd& force, BeamState& state,
                  const BeamStaticsOptions& options, BeamStaticsReport& report) {
    constexpr int most_mixed = 30;  // it takes 5 to 20, or does not converge
    const bool mixed = method == Method::mixed;
    double last = std::numeric_limits<double>::infinity();
    m_forces.assign(std::size_t(m_beam.element_count()), ElementForces());
    if (mixed) {  // those of the state, to start with
      Eigen::VectorXd ignored;
      m_beam.mixed_tangent(state, m_forces, ignored, m_K);
    }
    const int most = mixed ? std::min(most_mixed, options.max_iterations) : options.max_iterations;
    for (int i = 0; i < most; ++i) {
      ++report.iterations;
      if (!linearise(method, force, state)) return Outcome::not_converged;
      const double size = correction(m_step);
      // the last step is taken, and nothing after it: quadratic convergence makes it exact
      const bool rounding = size <= 1e-7 && size > 0.25 * last && m_full;
      if (size <= options.tolerance || rounding) {
        m_beam.update(state, m_step);
        report.correction = size;
        const bool minimum = m_shift == 0.0 && m_factor.positive();
        return minimum || !m_moments.empty() ? Outcome::converged : Outcome::saddle;
      }
      last = size;
      if (!(mixed ? bounded(state) : descend(force, state))) return Outcome::not_converged;
    }
    return Outcome::not_converged;
  }

  // Tangent, factor and Newton step; false: no usable factor.
  bool linearise(Method method, const Eigen::VectorXd& force, const BeamState& state) {
    Eigen::VectorXd gradient;
    m_energy = method == Method::mixed ? m_beam.mixed_tangent(state, m_forces, gradient, m_K)
                                       : m_beam.tangent(state, gradient, m_K);
    m_residual = (force - gradient).cwiseProduct(m_free);
    if (!std::isfinite(m_energy)) return false;
    for (const Index dof : m_fixed) m_K.fix(dof);
    m_step = m_residual;
    m_shift = 0.0;
    const bool usable = m_factor.factorise(m_K);
    if (!m_moments.empty()) {
      if (usable) turn_with_moments(force);
      return usable;
    }
    if (method == Method::descent && !m_factor.positive() && !shift()) return false;
    if (!usable && m_shift == 0.0) return false;
    m_factor.solve(m_step);
    return m_step.allFinite();
  }

  // Makes the tangent positive definite: adds growing parts of its own scale.
  bool shift() {
    Eigen::VectorXd scale = m_K.diagonal_entries().cwiseAbs();
    constexpr int most = 20;  // the last: 3e5
    for (int k = 0; k < most; ++k) {
      m_shift = std::ldexp(1e-6, 2 * k);
      BlockTridiagonal shifted = m_K;
      for (Index i = 0; i < shifted.blocks(); ++i) {
        shifted.diagonal(i).diagonal() += m_shift * scale.segment<6>(6 * i);
      }
      if (m_factor.factorise(shifted) && m_factor.positive()) return true;
    }
    return false;
  }

  // Solves (K - skew(m)/2) step = residual: a correction of low rank to the symmetric factor.
  void turn_with_moments(const Eigen::VectorXd& force) {
    const auto count = Eigen::Index(m_moments.size());
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(m_step.size(), 3 * count + 1);
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(3 * count, 3 * count);
    const auto gather = [&](const Eigen::MatrixXd& full) {
      Eigen::MatrixXd rows(3 * count, full.cols());
      for (Eigen::Index k = 0; k < count; ++k) {
        rows.middleRows<3>(3 * k) = full.middleRows<3>(6 * m_moments[std::size_t(k)] + 3);
      }
      return rows;
    };
    for (Eigen::Index k = 0; k < count; ++k) {
      const Index first = 6 * m_moments[std::size_t(k)] + 3;
      const Vec3 mask = m_free.segment<3>(first), moment = force.segment<3>(first);
      columns.block<3, 3>(first, 3 * k) = Mat3::Identity();
      C.block<3, 3>(3 * k, 3 * k) = -0.5 * (mask.asDiagonal() * skew(moment) * mask.asDiagonal());
    }
    columns.rightCols<1>() = m_residual;
    m_factor.solve(columns);
    const Eigen::MatrixXd picked = gather(columns);
    const Eigen::MatrixXd small =
        Eigen::MatrixXd::Identity(3 * count, 3 * count) + C * picked.leftCols(3 * count);
    const Eigen::VectorXd part = small.partialPivLu().solve(C * picked.rightCols<1>());
    m_step = columns.rightCols<1>() - columns.leftCols(3 * count) * part;
  }

  bool bounded(BeamState& state) {
    // rad; by trial: twice as much fails where this takes ten steps. Moments turn the far end by
    // right.
    const double most = m_moments.empty() ? 0.6 : 3.0;
    double largest = 0.0;
    for (Index i = 0; i < m_beam.node_count(); ++i) {
      largest = std::max(largest, m_step.segment<3>(6 * i + 3).norm());
    }
    m_full = largest <= most;
    if (!m_full) m_step *= most / largest;
    m_beam.predict(m_forces, m_step);
    m_beam.update(state, m_step);
    return m_step.allFinite();
  }

  bool descend(const Eigen::VectorXd& force, BeamState& state) {
    const double slope = m_residual.dot(m_step);  // what the energy falls by, to first order
    const double noise = 1e-14 * (std::abs(m_energy) + std::abs(force.dot(m_step)));
    constexpr int most_halvings = 39;  // to 2e-12
    for (int halvings = 0; halvings <= most_halvings; ++halvings) {
      const double part = std::ldexp(1.0, -halvings);
      BeamState next = state;
      const Eigen::VectorXd step = part * m_step;
      m_beam.update(next, step);
      const double change = m_beam.energy(next) - m_energy - force.dot(step);
      if (change <= -1e-4 * part * slope + noise) {
        m_full = part == 1.0 && m_shift == 0.0;
        state = std::move(next);
        return true;
      }
    }
    return false;
  }

  double correction(const Eigen::VectorXd& step) const {
    double size = 0.0;
    for (Index i = 0; i < m_beam.node_count(); ++i) {
      size = std::max({size, step.segment<3>(6 * i).norm() / m_beam.device().length(),
                       step.segment<3>(6 * i + 3).norm()});
    }
    return size;
  }

  const Beam& m_beam;
  const std::vector<Index>& m_fixed;
  Eigen::VectorXd m_free;               // 1, or 0 for fixed dofs
  Indices m_moments;                    // nodes that carry a moment
  std::vector<ElementForces> m_forces;  // per element
  BlockTridiagonal m_K;
  BlockTridiagonalFactor m_factor;
  Eigen::VectorXd m_residual, m_step;
  double m_energy = 0.0, m_shift = 0.0;
  bool m_full = true;
};

}  // namespace

BeamStaticsReport solve_statics(const Beam& beam, const BeamLoad& load, BeamState& state,
                                const BeamStaticsOptions& options, const Eigen::VectorXd& from) {
  if (load.force.size() != beam.dof_count() ||
      (from.size() != 0 && from.size() != beam.dof_count())) {
    throw Error(ErrorCode::size_mismatch, "beam '" + beam.device().name() +
                                              "': the load must have 6 entries per node, " +
                                              std::to_string(beam.dof_count()));
  }
  for (const Index dof : load.fixed) {
    if (dof < 0 || dof >= beam.dof_count()) {
      throw Error(ErrorCode::index_out_of_range,
                  "beam '" + beam.device().name() + "': there is no dof " + std::to_string(dof));
    }
  }
  const Eigen::VectorXd start =
      from.size() ? from : Eigen::VectorXd(Eigen::VectorXd::Zero(beam.dof_count()));
  BeamStaticsReport report;
  StaticNewton newton(beam, load);
  const double wanted = 1.0 / options.load_steps;
  double done = 0.0, step = wanted;
  while (done < 1.0) {
    const double part = done + step > 1.0 - 1e-9 ? 1.0 : done + step;
    const Eigen::VectorXd force = start + part * (load.force - start);
    auto outcome = newton.mixed(force, state, options, report);
    // small steps are cheaper than the descent, but lead only to the nearest equilibrium
    if (outcome == StaticNewton::Outcome::saddle || step < wanted / 16.0) {
      outcome = newton.descent(force, state, options, report);
    }
    if (outcome == StaticNewton::Outcome::converged) {
      done = part;
      step = std::min(2.0 * step, wanted);
    } else {
      step *= 0.5;
      if (step < wanted / 1024.0) return report;
    }
  }
  report.converged = true;
  return report;
}

}  // namespace brainshift
