// The scene of the procedure: what the library is handed.
#pragma once

#include "head.hpp"
#include "options.hpp"

namespace dbs {

struct SceneIds {   // constraint groups the results ask for; -1: not in the scene
  ConstraintId skull = -1, falx[2] = {-1, -1}, opposing = -1;
};

// Of the head in the first image, degrees.
double imaging_elevation(const Options& options);

// Gravity for a head elevated by `degrees` (RAS, mm/s^2), and the height axis that goes with it.
Vec3 gravity_of(double degrees);

// Of the brain where no part has its own, kg/mm^3: given, or from its mass.
double density_of(const Head& head, const Options& options);

Scene make_scene(const Head& head, const Options& options, SceneIds& ids);

// Level of the full fluid: the top of the cavity along -gravity (mm).
double full_level(const Head& head, const Vec3& gravity);

}  // namespace dbs
