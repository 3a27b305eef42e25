// Snapshots and recordings that were tampered with and sealed again: the checksum does not help there.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "brainshift/stepper.hpp"
#include "robustness/fuzz/numbers.hpp"
#include "robustness/fuzz/targets.hpp"
#include "stepper/bytes.hpp"
#include "stepper/scene_bytes.hpp"
#include "support/scenes.hpp"

namespace brainshift::test {
namespace {

constexpr std::size_t head = 32, seal = 8;   // of the envelope

// A block with a lead in fluid in a box, after a step. The smallest there is, for many executions.
Stepper in_use() {
  StepperOptions options;
  options.max_iterations = 6;
  options.smallest_load_step = 0.5;
  SurfaceOptions coarse;
  coarse.grid_spacing = 8.0;
  Stepper stepper(busy_scene(1, 0.3, coarse), options);
  stepper.insert(make_device("3389", 30.0), {{14.3, 15.7, 9.1}, Vec3::UnitZ()}, Hold{0.0, 28.0});
  stepper.csf().set_lost_volume(0, 100.0);
  stepper.step(0.1);
  return stepper;
}

Stepper held_without_walls() {
  Scene scene = busy_scene(1, 0.3);
  scene.constraints = {};
  scene.constraints.remove(scene.constraints.fix("gone", {0}));
  scene.constraints.fix("base", {0, 1});
  scene.constraints.support("stem", {2, 3}, Eigen::VectorXd::Constant(1, 0.3));
  return Stepper(scene);
}

// A few numbers in a file may ask for a grid of 2e8 distances to a wall (SurfaceOptions::grid_spacing), minutes of
// work that is no hang: where the points of the wall lie, how fine its grid and how wide its band is.
struct Kept {
  std::size_t at;
  Bytes bytes;
};

Kept find_kept(const Bytes& all, const double* values, std::size_t count) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(values);
  const Bytes bytes(first, first + count * sizeof(double));
  const auto found = std::search(all.begin(), all.end(), bytes.begin(), bytes.end());
  if (found == all.end()) std::abort();
  return {std::size_t(found - all.begin()), bytes};
}

std::vector<Kept> size_of_wall(const Bytes& recording) {
  const Scene scene = read_recording(recording).scene;
  const Surface& wall = *scene.constraints.groups().front().surface;
  const double options[] = {wall.options().grid_spacing, wall.options().band};
  return {find_kept(recording, wall.points().data(), std::size_t(wall.points().size())),
          find_kept(recording, options, 2)};
}

// Bytes of `good` overwritten as `data` says, three for each: a place, and another value there; words of
// special numbers for some, but for what is kept. Then its end cut off, for one in sixteen. Sealed.
Bytes tampered(Bytes bytes, Numbers& numbers, const std::vector<Kept>& kept = {}) {
  const std::size_t content = bytes.size() - head - seal;
  const int cut = numbers.byte();
  while (numbers.more()) {
    const std::size_t place = (numbers.byte() + 256u * numbers.byte()) % (content / 8) * 8 + head;
    const std::uint8_t way = numbers.byte();
    if (way < 200) {
      bytes[place + way % 8] = numbers.byte();
      continue;
    }
    const double value = numbers.number();
    std::uint64_t bits = std::uint64_t(std::int64_t(way) - 228);   // a count, or a number
    if (way >= 228) std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; ++i) bytes[place + std::size_t(i)] = std::uint8_t(bits >> 8 * i);
  }
  for (const Kept& k : kept) std::copy(k.bytes.begin(), k.bytes.end(), bytes.begin() + std::ptrdiff_t(k.at));
  const std::size_t left = cut < 16 ? content * std::size_t(cut) / 16 : content;
  bytes.resize(head + left + seal);
  for (int i = 0; i < 8; ++i) bytes[24 + std::size_t(i)] = std::uint8_t(left >> 8 * i);
  const std::uint64_t sum = checksum(bytes.data(), head + left);
  for (int i = 0; i < 8; ++i) bytes[head + left + std::size_t(i)] = std::uint8_t(sum >> 8 * i);
  return bytes;
}

// One in many goes on with a step, which takes a thousand times as long; not for the fuzzer to choose.
bool goes_on(const std::uint8_t* data, std::size_t size) {
  return checksum(data, size) % 8192 == 0;
}

void go_on(Stepper& stepper) {
  const SolveReport report = stepper.step(0.1);
  if (report.converged() && !stepper.displacement().allFinite()) std::abort();
  if (!report.converged() && report.message.empty()) std::abort();
}

}  // namespace

void fuzz_snapshot(const std::uint8_t* data, std::size_t size) {
  static Stepper stepper = in_use();
  static const std::shared_ptr<const Stepper::Snapshot> before = stepper.snapshot();
  static const Bytes good = bytes_of(*before);
  Numbers numbers(data, size);
  const bool step = goes_on(data, size);
  bool changed = false;
  try {
    stepper.restore(stepper.read_snapshot(tampered(good, numbers)));
    changed = true;
    if (step) go_on(stepper);
  } catch (const Error&) {
  }
  if (changed) stepper.restore(before);
  if (step && bytes_of(*stepper.snapshot()) != good) std::abort();
}

// Most are only read, and without walls: to make those takes a thousand times as long.
void fuzz_recording(const std::uint8_t* data, std::size_t size) {
  static const Bytes whole = in_use().record(), without_walls = held_without_walls().record();
  static const std::vector<Kept> kept = size_of_wall(whole);
  Numbers numbers(data, size);
  try {
    if (checksum(data, size) % 1024 != 0) {
      read_recording(tampered(without_walls, numbers));
      return;
    }
    Stepper stepper = Stepper::replay(tampered(whole, numbers, kept));
    if (goes_on(data, size)) go_on(stepper);
  } catch (const Error&) {
  }
}

}  // namespace brainshift::test
