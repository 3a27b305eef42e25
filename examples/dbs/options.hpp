// What the user of the example may choose.
#pragma once

#include <string>

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
  std::string head;
  std::string out = "out/dbs";
  std::string law = "corotational";
  double young = 6.0;             // kPa
  double poisson = 0.45;
  double density = 1040.0;        // kg/m^3
  double csf_density = 1000.0;    // kg/m^3
  std::string right = "20mL", left = "20mL";
  double late = 0.3;              // part of a side's loss that comes while electrodes are tested
  double elevation = 15.0;        // degrees, of the head
  std::string fluid = "communicating";
  std::string support = "elastic";
  bool falx = true, skull = true, balanced = true, files = true, quiet = false;
};

// Fills `options` from the command line; returns an exit code when the program should end (--help,
// a bad option), else -1.
int parse(int argc, char** argv, Options& options);

}  // namespace dbs
