// Cannula, electrode lead, wire: what a slender device is made of. An immutable value, validated at
// construction, cheap to copy (shared inside); where it is and how it bends is not in it.
//
// A device is a line of nodes, node 0 at the tip, running from the tip to the wire. Each node has a
// frame (d1, d2, d3): d1 along the line away from the tip, d2 and d3 across. Arc lengths count from
// the tip. Elements join neighbouring nodes and resist stretching, bending and torsion.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "brainshift/types.hpp"

namespace brainshift {

// Cross-section. 1 N mm^2 = 1000 mN mm^2.
struct BeamSection {
  double axial = 0.0;      // EA, mN
  double bending_2 = 0.0;  // EI for bending in the plane (d1, d2), mN mm^2
  double bending_3 = 0.0;  // EI for bending in the plane (d1, d3), mN mm^2
  double torsion = 0.0;    // GJ, mN mm^2
  double radius = 0.0;     // outer radius, mm: what tissue sees
  double shear = std::numeric_limits<double>::infinity();  // shear factor * GA, mN; infinite: none
  // kg/mm. Inertia in Stepper::step(), lumped at the nodes (half of each element to either end,
  // none in rotation); 0: massless, in balance at every instant. A Stepper never applies the weight
  // of a device, neither in statics nor in time.
  double line_density = 0.0;
};

// Round tube (inner diameter 0: a solid rod) of one material: E in kPa, density in kg/mm^3.
BeamSection tube_section(double outer_diameter, double inner_diameter, double young, double poisson,
                         double density = 0.0);

// Round device known by its bending stiffness alone (mN mm^2): stretching and torsion as a solid rod
// of that diameter and one material would have. `density` in kg/mm^3 of the full cross-section.
BeamSection rod_section(double diameter, double bending, double poisson, double density = 0.0);

struct SectionInterval {
  double from, to;  // arc length from the tip, mm
  BeamSection section;
};

// A metal ring that stimulates.
struct Contact {
  double from, to;  // arc length from the tip, mm
  double centre() const { return 0.5 * (from + to); }
};

class BeamDevice {
 public:
  // nodes: N x 3, N >= 2 (mm), the rest shape, curved or straight. sections: one for all, or one per
  // element. frames: N rotations with d1, d2, d3 as columns, or empty: d1 tangent to the polyline,
  // d2 carried along without twist. The curve follows d1 between the nodes; a frame turned by more
  // than a right angle against its chord is refused. Throws Error naming the culprit: empty,
  // size_mismatch, not_finite, degenerate_element, invalid_argument.
  BeamDevice(std::string name, Points nodes, std::vector<BeamSection> sections,
             std::vector<Contact> contacts = {}, std::vector<Mat3> frames = {});

  // Straight along +x, tip at the origin, frame along the axes, `elements` of equal length. Each
  // element takes the section of the interval that holds its middle; every one must find one.
  static BeamDevice straight(std::string name, double length, Index elements,
                             const std::vector<SectionInterval>& sections,
                             std::vector<Contact> contacts = {});
  static BeamDevice straight(std::string name, double length, Index elements,
                             const BeamSection& section, std::vector<Contact> contacts = {});

  const std::string& name() const;
  Index node_count() const;
  Index element_count() const;
  const Points& nodes() const;              // N x 3
  const std::vector<Mat3>& frames() const;  // N
  const BeamSection& section(Index element) const;
  const std::vector<Contact>& contacts() const;  // from the tip outwards

  // Arc length of each node; of the curve, not of the polyline.
  const Eigen::VectorXd& arcs() const;  // N, mm
  double length() const;                // mm
  // Element that holds the arc length (clamped to the ends); the lower one at a node.
  Index element_at(double arc) const;
  double radius_at(double arc) const { return section(element_at(arc)).radius; }

 private:
  struct Data;
  explicit BeamDevice(std::shared_ptr<const Data> data) : m_data(std::move(data)) {}
  std::shared_ptr<const Data> m_data;
};

// What is known of a device on the market. Lengths in mm, bending stiffness in mN mm^2.
struct DeviceData {
  const char* name;
  const char* description;  // with the sources of the numbers and what is assumed
  double outer_diameter;
  double tip;  // from the tip to the first contact
  int contact_count;
  double contact_length, contact_gap;
  double bending;                          // EI, default
  double bending_lowest, bending_highest;  // the range in which it is uncertain
};

struct DeviceOptions {
  double element_size = 2.0;  // mm; elements are no longer than this
  double bending = 0.0;       // EI, mN mm^2; 0: the table's
  double density = 0.0;       // kg/mm^3 of the full cross-section; 0: massless
};

std::vector<std::string> device_names();
// Throws Error(invalid_argument) naming the word and the known ones.
const DeviceData& device_data(const std::string& name);
// A straight device of the table, `length` mm long (tip to wire end).
BeamDevice make_device(const std::string& name, double length, const DeviceOptions& options = {});

}  // namespace brainshift
