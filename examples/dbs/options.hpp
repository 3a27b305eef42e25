// What the user of the example may choose.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "brainshift/brainshift.hpp"

namespace dbs {

using namespace brainshift;

// How much one side loses: mL of fluid, mL of air that enters, or mm by which the level falls.
struct Loss {
  FluidLaw law = FluidLaw::lost_volume;
  double amount = 0.0;   // mm^3, mm^3 or mm
};

// "20mL", "20mL-air", "35mm"; throws Error(invalid_argument) naming the word.
Loss parse_loss(const std::string& text);

struct Options {
  std::string preset = "default";
  std::string head;
  double scale = 1.0;             // of the head's lengths, about its AC
  double gap = 0.0;               // mm of fluid more between brain and skull
  std::string out = "out/dbs";
  std::string law = "corotational";
  std::string element = "linear";   // tets: linear, nodal (linear, volume at nodes), quadratic
  double young = 6.0;             // kPa
  double poisson = 0.45;
  double density = 1040.0;        // kg/m^3
  std::string materials;          // file for parts of the brain; empty: that of the head, if it has one
  double mass = 0.0;              // kg of the meshed brain; above 0 it sets the density
  double csf_density = 1000.0;    // kg/m^3
  std::string right = "20mL", left = "20mL";
  double late = 0.3;              // part of a side's loss that comes while electrodes are tested
  double elevation = 15.0;        // degrees, of the head in surgery
  double imaging_elevation = std::numeric_limits<double>::quiet_NaN();   // NaN: the same
  std::string fluid = "communicating";
  std::string support = "elastic";
  double tether = 0.003;          // kPa/mm, springs between the outside of the brain and the skull
  std::string still;              // a half of the brain that is held: left, right; empty: none
  double time_step = 0.0;         // s; above 0 a stage goes on in time until it rests
  // Electrodes.
  std::string sides = "both";     // that are operated on: both, right, left
  std::string first = "right";    // of both
  bool recover_between = false;   // the fluid comes back before the second side
  std::string target;             // landmark without its side (STN, GPi); empty: the head's plan
  std::vector<double> target_right, target_left;   // mm, RAS; empty: as above
  double sagittal = std::numeric_limits<double>::quiet_NaN();   // degrees; NaN: the head's plan
  double lateral = std::numeric_limits<double>::quiet_NaN();
  std::string aim = "skull";      // at the planned point of the skull frame, or of the tissue
  std::vector<double> offset_right, offset_left;   // mm, RAS; the aim from the target; empty: none
  int contact = 0;                // that is to lie at the target; 0: the tip
  bool devices = true;            // false: only fluid is lost
  std::string lead = "3389", test_electrode;   // of the device table; empty: the lead tests
  double bending = 0.0;           // N mm^2, EI of the lead; 0: the table's
  double friction = 0.0;          // kPa, bound of the shear between device and tissue
  double tip_hold = 0.0;          // mN of friction besides, at the tip, once the cannula has left
  double slack = 0.0;             // mm the wire may slide at the burr hole before the skull holds it
  bool clamped = false;           // the wire's tangent is held at the burr hole too
  bool local_give = false;        // ties give way by what tets wider than the device leave out
  double cannula_depth = 0.0;     // mm the cannula ends short of the target
  bool elastic_cannula = false;   // a steel beam held at the burr hole, instead of a rigid one
  bool estimate = false;          // the error of the mesh at the landmarks, stage by stage
  bool plan = false;              // look for choices that leave the electrodes nearest their targets
  int threads = 1;
  double accuracy = 0.0;   // mm, of what the solver leaves open; 0: as exact as it can be
  StepperOptions solver;   // where accuracy is 0; threads and progress are set from here
  std::string report;             // page about the results; empty: none
  std::string progress = "auto";  // auto (a line on a terminal), line, json, none
  bool falx = true, skull = true, balanced = true, files = true, vtk = true, quiet = false;
};

// What a preset stands for; throws Error(invalid_argument) naming the word and the known ones.
//   default     today's choices, docs/decisions/defaults-of-the-main-job.md
//   paper-2011  those of Bilger, Dequidt, Duriez, Cotin, MICCAI 2011, docs/decisions/paper-2011.md
Options preset(const std::string& name);

// Fills `options` from the command line; returns an exit code when the program should end (--help,
// a bad option), else -1.
int parse(int argc, char** argv, Options& options);

}  // namespace dbs
