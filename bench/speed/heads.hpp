// The head that benchmarks run on.
#pragma once

#include "scene.hpp"

namespace bench {

// Read once, from the folder the program was given; throws brainshift::Error.
const dbs::Head& head();

}  // namespace bench
