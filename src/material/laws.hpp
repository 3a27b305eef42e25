// The laws, one file each.
#pragma once

#include "material/law.hpp"

namespace brainshift {

extern const LawFunctions linear_law;
extern const LawFunctions corotational_law;
extern const LawFunctions st_venant_kirchhoff_law;
extern const LawFunctions stable_neo_hookean_law;
extern const LawFunctions log_neo_hookean_law;

}  // namespace brainshift
