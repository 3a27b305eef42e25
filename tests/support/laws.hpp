// Every law, for tests that hold for each of them.
#pragma once

#include "brainshift/material.hpp"

namespace brainshift::test {

constexpr Law all_laws[] = {Law::linear, Law::corotational, Law::st_venant_kirchhoff,
                            Law::stable_neo_hookean, Law::log_neo_hookean};
constexpr Law nonlinear_laws[] = {Law::corotational, Law::st_venant_kirchhoff,
                                  Law::stable_neo_hookean, Law::log_neo_hookean};

// Whether the law has an energy where the volume is gone or turned inside out.
inline bool allows_inversion(Law law) { return law != Law::log_neo_hookean; }

}  // namespace brainshift::test
