// A block of tissue that leans under gravity, and devices to put into it.
#pragma once

#include <array>
#include <limits>

#include "brainshift/brainshift.hpp"
#include "support/scenes.hpp"

namespace brainshift::test {

// Where the devices go: oblique to the mesh, the wire end above the block, where the skull would be.
const Vec3 lead_tip(19.3, 20.7, 22.1), lead_outward = Vec3(0.1, 0.05, 1.0).normalized();
constexpr double wire = 50.0;  // mm from the tip
constexpr double device_length = 55.0;
constexpr double block_height = 60.0;

// Block 40 x 40 x 60 mm of brain, free of load, held at its base, under `gravity` (mm/s^2).
inline Scene block_on_base(const Vec3& gravity, const std::array<int, 3>& cells = {4, 4, 6}) {
  const Mesh mesh = make_mesh(make_box({40.0, 40.0, block_height}, cells[0], cells[1], cells[2]));
  Scene scene{mesh, {{0, Material(Law::corotational, 6.0, 0.45, tissue_density)}}, gravity};
  scene.balanced_reference = false;
  scene.constraints.fix("base", nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; }));
  return scene;
}

inline Vec3 leaning(double part) { return {part * 9810.0, 0.0, 0.0}; }
inline Scene leaning_block(double part = 0.02) { return block_on_base(leaning(part)); }

inline BeamDevice lead(double bending = 5000.0) {  // mN mm^2
  DeviceOptions options;
  options.bending = bending;
  return make_device("3389", device_length, options);
}

inline Hold whole() { return {0.0, wire, false, 0.0}; }
inline Hold wire_only(double slack = 0.0) {
  return {std::numeric_limits<double>::infinity(), wire, false, slack};
}

}  // namespace brainshift::test
