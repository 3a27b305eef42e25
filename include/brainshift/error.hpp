// The one exception type of libbrainshift.
#pragma once

#include <stdexcept>
#include <string>

namespace brainshift {

enum class ErrorCode {
  invalid_argument,         // a parameter outside its range; the message names it and the range
  empty,                    // an array that must hold something holds nothing
  size_mismatch,            // two arrays that belong together differ in length
  index_out_of_range,       // an index refers to something that is not there
  not_finite,               // NaN or infinity in the input
  inverted_element,         // a tet with negative volume
  degenerate_element,       // a tet without volume, or a triangle without area
  duplicate_element,        // the same tet twice
  orphan_node,              // a node that no tet uses
  surface_not_closed,       // a surface that must enclose a volume has a free edge
  initial_penetration,      // a one-sided constraint violated before anything has moved
  conflicting_constraints,  // rows that contradict each other
  rigid_mode,               // a body that nothing holds, in a quasi-static solve
  fluid_volume,             // more fluid asked for than there is, or less than none
  linear_solver,            // a factorisation that failed for reasons of its own (memory, size)
  file,                     // a file that cannot be read or written, or holds something else
  internal                  // a promise of the library itself is broken: please report
};

const char* to_string(ErrorCode code);

// Thrown by every part of the library; what() is one sentence that names the culprit.
// The object a failing call was made on is left as it was.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), m_code(code) {}
  ErrorCode code() const noexcept { return m_code; }

 private:
  ErrorCode m_code;
};

}  // namespace brainshift
