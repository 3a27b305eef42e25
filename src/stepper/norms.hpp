// Norms of vectors that may be empty.
#pragma once

#include <Eigen/Core>

namespace brainshift {

inline double max_norm(const Eigen::VectorXd& v) {
  return v.size() ? v.lpNorm<Eigen::Infinity>() : 0.0;
}

}  // namespace brainshift
