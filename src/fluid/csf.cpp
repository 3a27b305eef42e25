#include "brainshift/csf.hpp"

#include <cmath>

#include "brainshift/error.hpp"
#include "mesh/surface_topology.hpp"
#include "text.hpp"

namespace brainshift {

Csf::Csf(double density, FluidModel model, std::vector<Compartment> compartments,
         double reference_head)
    : m_density(density),
      m_model(model),
      m_compartments(std::move(compartments)),
      m_reference_head(reference_head) {
  if (!(density > 0.0) || !std::isfinite(density)) {
    throw Error(ErrorCode::invalid_argument,
                "Csf: density = " + text(density) + " kg/mm^3 is not positive");
  }
  if (std::isinf(reference_head)) {
    throw Error(ErrorCode::invalid_argument, "Csf: the reference head is infinite");
  }
  if (m_compartments.empty()) throw Error(ErrorCode::empty, "Csf: no compartment is given");
  for (std::size_t i = 0; i < m_compartments.size(); ++i) {
    const Compartment& c = m_compartments[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (m_compartments[j].name == c.name) {
        throw Error(ErrorCode::invalid_argument,
                    "Csf: two compartments are called '" + c.name + "'");
      }
    }
    require_closed(c.wall_points, c.wall_triangles, "the wall of compartment '" + c.name + "'");
  }
  m_settings.resize(m_compartments.size());
}

Index Csf::find(const std::string& name) const {
  for (std::size_t i = 0; i < m_compartments.size(); ++i) {
    if (m_compartments[i].name == name) return Index(i);
  }
  throw Error(ErrorCode::invalid_argument, "Csf: there is no compartment '" + name + "'");
}

std::size_t Csf::checked(Index compartment) const {
  if (compartment < 0 || compartment >= compartment_count()) {
    throw Error(ErrorCode::index_out_of_range, "Csf: compartment " + std::to_string(compartment) +
                                                   " of " + std::to_string(compartment_count()));
  }
  return std::size_t(compartment);
}

void Csf::set(Index compartment, FluidLaw law, double amount) {
  const std::string& name = m_compartments[checked(compartment)].name;
  if (!std::isfinite(amount)) {
    throw Error(ErrorCode::not_finite, "Csf: the amount set for '" + name + "' is not finite");
  }
  if (law == FluidLaw::air_volume && amount < 0.0) {
    throw Error(ErrorCode::fluid_volume, "Csf: a volume of " + text(amount) +
                                             " mm^3 set for '" + name + "' is negative");
  }
  const bool open = law != FluidLaw::full;
  m_settings[std::size_t(compartment)] = {open, law, amount};
  if (m_model == FluidModel::separate) return;
  for (Setting& other : m_settings) {  // one fluid, one law, among the open compartments
    if (other.open && open) other = {true, law, amount};
  }
}

void Csf::open(Index compartment) {
  const bool communicating = m_model == FluidModel::communicating;
  for (const Setting& other : m_settings) {
    if (communicating && other.open) return set(compartment, other.law, other.amount);
  }
  set(compartment, FluidLaw::lost_volume, 0.0);
}

void Csf::set_full(Index compartment) { set(compartment, FluidLaw::full, 0.0); }

void Csf::set_level(Index compartment, double height) { set(compartment, FluidLaw::level, height); }

void Csf::set_lost_volume(Index compartment, double mm3) {
  set(compartment, FluidLaw::lost_volume, mm3);
}

void Csf::set_air_volume(Index compartment, double mm3) {
  set(compartment, FluidLaw::air_volume, mm3);
}

}  // namespace brainshift
