// The parts of a scene as bytes.
#pragma once

#include "brainshift/stepper.hpp"
#include "stepper/bytes.hpp"

namespace brainshift {

void put_mesh(ByteWriter& w, const Mesh& mesh);
void put_constraints(ByteWriter& w, const ConstraintSet& set);   // all but what is enabled
void put_fluid(ByteWriter& w, const Csf& csf);                   // all but its settings

// Groups that are added to the set from now on are numbered from `next`.
void skip_ids(ConstraintSet& set, ConstraintId next);

// What a host may change of a fluid between solves.
void put_fluid_settings(ByteWriter& w, const Csf& csf);
void get_fluid_settings(ByteReader& r, Csf& csf);

// What Stepper::replay() makes a stepper of.
struct Recording {
  Scene scene;
  StepperOptions options;
  Bytes state;   // a snapshot
};
Recording read_recording(const Bytes& bytes);   // throws Error(file)

}  // namespace brainshift
