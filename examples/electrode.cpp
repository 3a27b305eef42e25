// A cannula goes in, a lead takes its place in it, fluid is lost, the cannula leaves, and the lead bows
// with the tissue that moves around it.
//
//      |  wire, held where it leaves the skull
//    +-|-----+
//    | |     |    lead: 3389, four contacts above its tip
//    | v     |
//    +=======+
//
// Build:  c++ -std=c++17 electrode.cpp $(pkg-config --cflags --libs brainshift) -o electrode
// Prints: a line per stage with tip, bow and force, and a hash of the last state: python/electrode.py
//         prints the same lines, to the same bits.
#include <cstdio>
#include <limits>

#include "block.hpp"

using namespace brainshift;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double length = 45.0;   // mm, from the tip to where the skull holds the wire

void say(const char* stage, const Stepper& stepper, DeviceId id) {
  const DeviceState d = stepper.device(id);
  std::printf("%-18s tip (%.6f, %.6f, %.6f) mm, bow %.6f mm, held with %.6f mN\n", stage, d.nodes(0, 0),
              d.nodes(0, 1), d.nodes(0, 2), d.bow, d.anchor_force.norm());
}

void solve(Stepper& stepper) {
  const SolveReport report = stepper.solve_static();
  if (!report.converged()) throw Error(ErrorCode::internal, report.message);
}

// FNV-1a over the bits of the numbers.
void add_to_hash(const Points& values, std::uint64_t& hash) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t i = 0; i < sizeof(double) * std::size_t(values.size()); ++i) {
    hash = (hash ^ bytes[i]) * 0x100000001b3u;
  }
}

}  // namespace

int main() try {
  Stepper stepper(block_scene());
  const Placement placement{{22.0, 33.0, 21.0}, {0.0, 0.0, 1.0}};

  // 1. The frame holds all of the cannula; friction bounds the shear along it.
  TrackOptions track;
  track.shear_bound = 0.05;   // kPa
  const DeviceId id = stepper.insert(make_device("cannula", length), placement, Hold{0.0}, track);
  solve(stepper);
  say("cannula in", stepper, id);

  // 2. The lead in it, 2 mm deeper than its end.
  stepper.exchange(id, make_device("3389", length), Hold{2.0, length}, 2.0);
  solve(stepper);
  say("lead in", stepper, id);

  // 3. Fluid is lost while the lead is tested.
  stepper.csf().set_lost_volume(0, 350.0 * mm3_per_ml);
  solve(stepper);
  say("fluid lost", stepper, id);

  // 4. The cannula leaves: only the wire is held now, with 1 mm of slack.
  stepper.set_hold(id, Hold{infinity, length, false, 1.0});
  solve(stepper);
  say("cannula out", stepper, id);

  std::uint64_t hash = 0xcbf29ce484222325u;
  add_to_hash(stepper.displacement(), hash);
  add_to_hash(stepper.device(id).nodes, hash);
  std::printf("state %016llx\n", static_cast<unsigned long long>(hash));
  return stepper.device(id).bow > 0.0 ? 0 : 1;
} catch (const Error& error) {
  std::fprintf(stderr, "%s: %s\n", to_string(error.code()), error.what());
  return 1;
}
