// Cerebrospinal fluid: compartments of a rigid cavity that hold fluid, air, and tissue.
//
// Heights are measured along -gravity from the origin (mm). A fluid with head h exerts the pressure
// p = density |g| (h - height) on the wetted faces of the *deformed* mesh. Where a compartment is
// open, air enters above the level and p is cut off at 0; a closed compartment holds no air.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "brainshift/types.hpp"

namespace brainshift {

enum class FluidModel {
  separate,      // each compartment has its own head; one that is not open stays full
  communicating  // one head for all; compartments that are not open may be under suction
};

// What the host tells about one compartment.
struct Compartment {
  std::string name;
  // Closed rigid wall, outward triangles; its volume holds tissue, fluid and air (mm).
  Points wall_points;
  Triangles wall_triangles;
  // Rows of Mesh::surface(): the closed surface of the tissue counted as inside the compartment,
  // and the part of it that fluid can wet (not: where tissue goes on across a cut or a seam).
  Indices body_faces;
  Indices wetted_faces;
};

// How the head of an open compartment (or of the one communicating fluid) is determined.
enum class FluidLaw {
  full,         // reference head: nothing has been lost
  level,        // the head is given (mm)
  lost_volume,  // the fluid lost since the reference state is given (mm^3); the level is solved for
  air_volume    // the air in the open compartments is given (mm^3); the level is solved for
};

class Csf {
 public:
  // density > 0 (kg/mm^3). reference_head: level of the full fluid along -gravity (mm); not below
  // the top of any wall (checked when a Stepper is made, which knows gravity); NaN, the default:
  // exactly that top. Throws invalid_argument, surface_not_closed, index_out_of_range.
  Csf(double density, FluidModel model, std::vector<Compartment> compartments,
      double reference_head = std::numeric_limits<double>::quiet_NaN());

  double density() const { return m_density; }
  FluidModel model() const { return m_model; }
  double reference_head() const { return m_reference_head; }
  Index compartment_count() const { return Index(m_compartments.size()); }
  const Compartment& compartment(Index i) const { return m_compartments[checked(i)]; }
  Index find(const std::string& name) const;  // throws invalid_argument naming it

  // All that takes the number of a compartment throws index_out_of_range for one that is not there.
  // Settings; they take effect at the next solve. With FluidModel::communicating the law given to
  // any open compartment is that of the one fluid, and amounts count for all together.
  void open(Index compartment);                         // air may enter from now on
  void set_full(Index compartment);                     // closes it and restores its fluid
  void set_level(Index compartment, double height);     // mm along -gravity; opens it
  // Since the reference state; below 0: more fluid than there, in the room of a brain that has shrunk.
  void set_lost_volume(Index compartment, double mm3);  // opens it
  void set_air_volume(Index compartment, double mm3);   // >= 0; opens it

  bool is_open(Index compartment) const { return m_settings[checked(compartment)].open; }
  FluidLaw law(Index compartment) const { return m_settings[checked(compartment)].law; }
  double amount(Index compartment) const { return m_settings[checked(compartment)].amount; }

 private:
  struct Setting {
    bool open = false;
    FluidLaw law = FluidLaw::full;
    double amount = 0.0;
  };
  std::size_t checked(Index compartment) const;
  void set(Index compartment, FluidLaw law, double amount);

  double m_density;
  FluidModel m_model;
  std::vector<Compartment> m_compartments;
  double m_reference_head;
  std::vector<Setting> m_settings;
};

// What a solve found in one compartment.
struct CompartmentState {
  double head;           // mm along -gravity; pressure is zero there
  double fluid_volume;   // mm^3
  double air_volume;     // mm^3: wall volume above the level minus tissue above it; 0 if closed
  double tissue_volume;  // mm^3, all of it
  double lost_volume;    // mm^3 of fluid since the reference state
  bool open;
};

}  // namespace brainshift
