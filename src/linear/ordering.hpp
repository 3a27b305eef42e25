// Fill-reducing order of a graph by METIS nested dissection.
#pragma once

#include "brainshift/types.hpp"

namespace brainshift {

// adjacency[i]: neighbours of i, without i; symmetric. Returns position[i]: the place of i in the
// new order. Deterministic; leaves signal handlers and the state of rand() as they were.
Indices nested_dissection(const std::vector<Indices>& adjacency);

}  // namespace brainshift
