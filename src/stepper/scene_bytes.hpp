// The parts of a scene as bytes.
#pragma once

#include "brainshift/stepper.hpp"
#include "stepper/bytes.hpp"

namespace brainshift {

void put_mesh(ByteWriter& w, const Mesh& mesh);
void put_constraints(ByteWriter& w, const ConstraintSet& set);   // all but what is enabled
void put_fluid(ByteWriter& w, const Csf& csf);                   // all but its settings

// What a host may change of a fluid between solves.
void put_fluid_settings(ByteWriter& w, const Csf& csf);
void get_fluid_settings(ByteReader& r, Csf& csf);

}  // namespace brainshift
