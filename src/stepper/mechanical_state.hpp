// What changes in a solve.
#pragma once

#include <vector>

#include "coupling/inserted_device.hpp"

namespace brainshift {

struct MechanicalState {
  Points u;                         // N x 3, mm
  std::vector<double> multipliers;  // mN, per contact row
  std::vector<DeviceMotion> devices;
};

}  // namespace brainshift
