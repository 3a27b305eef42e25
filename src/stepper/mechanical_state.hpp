// What changes in a solve.
#pragma once

#include <vector>

#include "coupling/inserted_device.hpp"

namespace brainshift {

struct MechanicalState {
  Points u;                         // N x 3, mm
  std::vector<double> multipliers;  // mN, per contact row
  std::vector<DeviceMotion> devices;
  // What the last static solve left open: forces (mN) and ties (mm). No more than that is no change.
  double open_force = 0.0, open_tie = 0.0;
};

}  // namespace brainshift
