// The scenes of the axes that other programs are tried on too.
#pragma once

#include "axes.hpp"

namespace brainshift::stability {

// A bar free of load on its base, whose heavy head presses it; one gravity is a pressure of one Young's modulus.
struct Bar {
  const char* name;
  bool confined;  // no node moves sideways, so that strain is uniform and every element exact;
                  // else base and head are held, and the sides are free
  double poisson;
};
constexpr Bar bars[] = {{"confined, nu 0", true, 0.0},
                        {"confined, nu 0.45", true, 0.45},
                        {"free sides, nu 0.45", false, 0.45}};
constexpr double bar_height = 40.0;   // mm; 20 mm wide
Scene pressed_bar(const Bar& bar, Law law);

// A cube of 20 mm that leans under gravity across it.
Scene leaning_cube(Law law, double poisson, int cells);
constexpr double below_half[] = {2e-1, 5e-2, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10};

// A bar of 60 mm, without gravity.
Scene bent_bar(Law law);
constexpr double loads_across[] = {0.3, 3.0};   // gravities
constexpr int call_counts[] = {1, 4, 16};

}  // namespace brainshift::stability
