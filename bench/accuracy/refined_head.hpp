// A head with every tet cut into eight: the same geometry, half the edge.
#pragma once

#include "head.hpp"

namespace dbs {

Head refined(const Head& head);

}  // namespace dbs
