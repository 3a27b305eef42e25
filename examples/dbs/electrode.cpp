#include "electrode.hpp"

#include <cmath>
#include <limits>

namespace dbs {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

void require(bool good, const std::string& what) {
  if (!good) throw Error(ErrorCode::invalid_argument, what);
}

}  // namespace

Electrode::Electrode(const Options& options, const Trajectory& trajectory)
    : m_options(options), m_trajectory(trajectory) {
  for (const std::string& name : {options.lead, options.test_electrode}) {
    require(name.empty() || device_data(name).contact_count > 0, "'" + name + "' is no electrode");
  }
  const auto fine = [](double x) { return std::isfinite(x) && x >= 0.0; };
  require(fine(options.bending), "--bending is negative or not a number");
  require(fine(options.friction), "--friction is negative or not a number");
  require(fine(options.tip_hold), "--tip-hold is negative or not a number");
  require(fine(options.slack), "--slack is negative or not a number");
  require(fine(options.cannula_depth) && options.cannula_depth < 0.5 * trajectory.length,
          "--cannula-depth is negative or more than half of the trajectory");
}

Placement Electrode::cannula_placement() const {
  return {m_trajectory.target + m_options.cannula_depth * m_trajectory.outward,
          m_trajectory.outward};
}

BeamDevice Electrode::cannula() const {
  return make_device("cannula", m_trajectory.length - m_options.cannula_depth);
}

// The frame holds all of a rigid cannula; of an elastic one, its end at the burr hole.
Hold Electrode::cannula_hold() const {
  const double end = m_trajectory.length - m_options.cannula_depth;
  return {m_options.elastic_cannula ? end : 0.0, never, false, 0.0};
}

TrackOptions Electrode::track() const {
  TrackOptions options;
  options.shear_bound = m_options.friction;
  options.local_give = m_options.local_give;
  return options;
}

BeamDevice Electrode::bare_lead(const std::string& name) const {
  DeviceOptions options;
  options.bending = 1e3 * m_options.bending;   // N mm^2 -> mN mm^2
  return make_device(name, m_trajectory.length, options);
}

BeamDevice Electrode::lead_in_cannula(const std::string& name) const {
  const BeamDevice lead = bare_lead(name);
  if (!m_options.elastic_cannula) return lead;
  // Coaxial: they bend as one, and steel outweighs what is inside it.
  std::vector<SectionInterval> sections;
  const BeamSection steel = cannula().section(0);
  const double depth = m_options.cannula_depth;
  if (depth > 0.0) sections.push_back({0.0, depth, lead.section(0)});
  sections.push_back({depth, m_trajectory.length, steel});
  return BeamDevice::straight(name + " in cannula", m_trajectory.length, lead.element_count(),
                              sections, lead.contacts());
}

Hold Electrode::hold_in_cannula() const {
  const double held = m_options.elastic_cannula ? m_trajectory.length : m_options.cannula_depth;
  return {held, m_trajectory.length, false, 0.0};
}

BeamDevice Electrode::lead() const { return bare_lead(m_options.lead); }

Hold Electrode::hold_of_wire() const {
  return {never, m_trajectory.length, m_options.clamped, m_options.slack};
}

}  // namespace dbs
