// How far each law, element and solver gets along the axes on which methods fail. bench/stability/run
// runs it, one axis at a time, so that an axis that ends the process leaves the others.
#include <cstring>

#include "axes.hpp"

namespace {

struct Axis {
  const char* name;
  void (*run)();
};

using namespace brainshift::stability;
constexpr Axis axes[] = {
    {"compression", compression},     {"poisson", poisson},
    {"load_steps", load_steps},       {"time_steps", time_steps},
    {"stiffness", stiffness},         {"devices_on_one_track", devices_on_one_track},
    {"repeated_rows", repeated_rows}, {"repeated_rows_by_siconos", repeated_rows_by_siconos},
    {"calculix_decks", calculix_decks}};

}  // namespace

int main(int argc, char** argv) {
  for (const Axis& axis : axes) {
    if (argc != 2 || std::strcmp(argv[1], axis.name) != 0) continue;
    std::setvbuf(stdout, nullptr, _IOLBF, 1 << 12);  // what is done stays when an axis is cut off
    axis.run();
    return 0;
  }
  std::fprintf(stderr, "usage: bench_stability AXIS; axes:");
  for (const Axis& axis : axes) std::fprintf(stderr, " %s", axis.name);
  std::fprintf(stderr, "\n");
  return 2;
}
