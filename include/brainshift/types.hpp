// Basic types of libbrainshift.
//
// Units, everywhere: mm, kg, s. Hence force mN, stress kPa, energy uJ (mN mm), density kg/mm^3.
// Examples: E = 6 (kPa), density = 1.04e-6 (1040 kg/m^3), g = 9810 (mm/s^2); 1 mL = 1000 mm^3.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "brainshift/eigen_abi.hpp"

namespace brainshift {

using Index = std::int32_t;

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

// N x 3, one point (or vector) per row, row-major: the memory layout of numpy and VTK.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
// M x 4 node indices of linear tets; (p1-p0) x (p2-p0) . (p3-p0) > 0.
using Tets = Eigen::Matrix<Index, Eigen::Dynamic, 4, Eigen::RowMajor>;
// M x 6 nodes on the edges 01, 12, 02, 03, 13, 23 of quadratic tets (the order of VTK).
using EdgeNodes = Eigen::Matrix<Index, Eigen::Dynamic, 6, Eigen::RowMajor>;
// K x 3 node indices, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<Index, Eigen::Dynamic, 3, Eigen::RowMajor>;

using Indices = std::vector<Index>;
using Bytes = std::vector<std::uint8_t>;

constexpr double standard_gravity = 9810.0;  // mm/s^2
constexpr double mm3_per_ml = 1000.0;

}  // namespace brainshift
