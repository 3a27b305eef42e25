// One point of the chart: a scene, and how it is solved.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "head.hpp"
#include "options.hpp"
#include "probes.hpp"

namespace bench {

struct Case {
  std::string head = "coarse";
  std::string scene = "csf_loss";    // stages 0 and 1 without devices, or procedure: all of them
  std::string law = "corotational", element = "linear";
  double poisson = 0.45;
  double accuracy = 0.0;             // mm; 0: the stepper's own tolerances
  bool one_linearisation = false;    // for each solve, whatever it leaves open
  int load_steps = 1;                // solves that share the loss of fluid
  int threads = 1;
  int refinements = 0;               // of the mesh; the scene csf_loss only
};

// Throws brainshift::Error naming a key that is unknown or of another type.
Case case_from(const nlohmann::json& json);

// Air that enters on each side, mL: a volume that does not depend on how well a mesh follows the tissue's.
constexpr double air = 20.0;

struct Solved {
  std::string stage;
  brainshift::SolveReport report;
  std::vector<dbs::Vec3> shift;      // mm, of the probes, since stage 0
  std::vector<std::pair<std::string, dbs::Vec3>> tips;   // mm; of leads, from their targets
};

struct Outcome {
  brainshift::Index nodes = 0, tets = 0;
  std::vector<Solved> stages;        // to the first that found no balance
  double setup_cpu = 0.0;            // s, from the head to a stepper that is ready
  double cpu = 0.0, wall = 0.0;      // s, of all stages from there
};

Outcome run(const dbs::Head& head, const Case& wanted, const std::vector<Probe>& probes);

}  // namespace bench
