#include "brainshift/error.hpp"

namespace brainshift {

const char* to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::invalid_argument: return "invalid_argument";
    case ErrorCode::empty: return "empty";
    case ErrorCode::size_mismatch: return "size_mismatch";
    case ErrorCode::index_out_of_range: return "index_out_of_range";
    case ErrorCode::not_finite: return "not_finite";
    case ErrorCode::inverted_element: return "inverted_element";
    case ErrorCode::degenerate_element: return "degenerate_element";
    case ErrorCode::duplicate_element: return "duplicate_element";
    case ErrorCode::orphan_node: return "orphan_node";
    case ErrorCode::surface_not_closed: return "surface_not_closed";
    case ErrorCode::initial_penetration: return "initial_penetration";
    case ErrorCode::conflicting_constraints: return "conflicting_constraints";
    case ErrorCode::rigid_mode: return "rigid_mode";
    case ErrorCode::fluid_volume: return "fluid_volume";
    case ErrorCode::linear_solver: return "linear_solver";
    case ErrorCode::file: return "file";
    case ErrorCode::internal: return "internal";
  }
  return "unknown";
}

}  // namespace brainshift
