// Where a Law finds its functions and its names.
#pragma once

#include "brainshift/material.hpp"
#include "material/law.hpp"

namespace brainshift {

// Throws Error(invalid_argument) for a value outside the enum (they arrive through the C API).
// The reference lives as long as the program: fetch it once per region, not once per element.
const LawFunctions& law_functions(Law law);

inline Lame lame_of(const Material& material) { return {material.mu(), material.lambda()}; }

}  // namespace brainshift
