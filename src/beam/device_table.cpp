// The devices of the table.
#include <cmath>

#include "brainshift/beam_device.hpp"
#include "brainshift/error.hpp"
#include "text.hpp"

namespace brainshift {
namespace {

constexpr double pi = 3.14159265358979323846;

// Steel tube of the cannula.
constexpr double cannula_outer = 1.8, cannula_inner = 1.4;  // mm
constexpr double steel_young = 2e8;                         // kPa
constexpr double steel_poisson = 0.3;
constexpr double cannula_bending =
    steel_young * pi / 64.0 *
    (cannula_outer * cannula_outer * cannula_outer * cannula_outer -
     cannula_inner * cannula_inner * cannula_inner * cannula_inner);  // 6.53e7 mN mm^2

// Leads: no bending stiffness is published. The range spans a bare polymer tube with thin wires and
// a lead with its stylet inside; without the stylet 1 to 20 N mm^2. Poisson's ratio of the polymer.
constexpr double lead_bending = 5e3, lead_lowest = 1e3, lead_highest = 1e5;  // mN mm^2
constexpr double lead_poisson = 0.45;

const DeviceData table[] = {
    {"cannula",
     "steel guide tube, 1.8/1.4 mm; EI = E pi (D^4 - d^4)/64 with E = 200 GPa; range: 190-210 GPa",
     cannula_outer, 0.0, 0, 0.0, 0.0, cannula_bending, 0.95 * cannula_bending,
     1.05 * cannula_bending},
    {"3389",
     "Medtronic lead, 1.27 mm, four contacts of 1.5 mm, gaps 0.5 mm, tip 1.5 mm (maker's data); "
     "EI assumed, unpublished; EA and GJ as a solid rod of that EI",
     1.27, 1.5, 4, 1.5, 0.5, lead_bending, lead_lowest, lead_highest},
    {"3387",
     "Medtronic lead, 1.27 mm, four contacts of 1.5 mm, gaps 1.5 mm, tip 1.5 mm (maker's data); "
     "EI assumed, unpublished; EA and GJ as a solid rod of that EI",
     1.27, 1.5, 4, 1.5, 1.5, lead_bending, lead_lowest, lead_highest},
    {"vercise",
     "Boston Scientific lead, 1.3 mm, eight contacts of 1.5 mm, gaps 0.5 mm (maker's data); tip "
     "1.1 mm assumed; EI assumed, unpublished; EA and GJ as a solid rod of that EI",
     1.3, 1.1, 8, 1.5, 0.5, lead_bending, lead_lowest, lead_highest},
};

void require_positive(const std::string& name, const char* what, double value) {
  if (!std::isfinite(value) || !(value > 0.0)) {
    throw Error(std::isfinite(value) ? ErrorCode::invalid_argument : ErrorCode::not_finite,
                "device '" + name + "': " + what + " = " + text(value) + " is not positive");
  }
}

BeamSection section_of(const DeviceData& data, const DeviceOptions& options) {
  const double bending = options.bending == 0.0 ? data.bending : options.bending;
  require_positive(data.name, "bending", bending);
  const bool steel = data.contact_count == 0;
  if (!steel) return rod_section(data.outer_diameter, bending, lead_poisson, options.density);
  const double young = steel_young * bending / cannula_bending;
  return tube_section(cannula_outer, cannula_inner, young, steel_poisson, options.density);
}

}  // namespace

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const DeviceData& data : table) names.emplace_back(data.name);
  return names;
}

const DeviceData& device_data(const std::string& name) {
  std::string known;
  for (const DeviceData& data : table) {
    if (name == data.name) return data;
    known += (known.empty() ? "" : ", ") + std::string(data.name);
  }
  throw Error(ErrorCode::invalid_argument, "unknown device '" + name + "'; known: " + known);
}

BeamDevice make_device(const std::string& name, double length, const DeviceOptions& options) {
  const DeviceData& data = device_data(name);
  require_positive(name, "length", length);
  require_positive(name, "element_size", options.element_size);
  const double wanted = std::ceil(length / options.element_size * (1.0 - 1e-12));
  constexpr double most = 1e6;  // elements: beyond it the size was meant in another unit
  if (wanted > most) {
    throw Error(ErrorCode::invalid_argument, "device '" + name +
                                                 "': element_size = " + text(options.element_size) +
                                                 " mm makes " + text(wanted) + " elements");
  }
  std::vector<Contact> contacts;
  for (int k = 0; k < data.contact_count; ++k) {
    const double from = data.tip + k * (data.contact_length + data.contact_gap);
    contacts.push_back({from, from + data.contact_length});
  }
  return BeamDevice::straight(name, length, Index(std::max(1.0, wanted)), section_of(data, options),
                              std::move(contacts));
}

}  // namespace brainshift
