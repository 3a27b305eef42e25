// All of libbrainshift's C++ face.
#pragma once

#include "brainshift/beam_device.hpp"
#include "brainshift/constraint_set.hpp"
#include "brainshift/csf.hpp"
#include "brainshift/error.hpp"
#include "brainshift/material.hpp"
#include "brainshift/mcp.hpp"
#include "brainshift/mesh.hpp"
#include "brainshift/stepper.hpp"
#include "brainshift/surface.hpp"
#include "brainshift/types.hpp"
