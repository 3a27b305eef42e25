#include "brainshift/eigen_abi.hpp"

namespace brainshift {

const char BRAINSHIFT_EIGEN_ABI = 0;

}  // namespace brainshift
