// Small beams to try things on.
#pragma once

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "beam/centreline.hpp"
#include "beam/rotation.hpp"
#include "beam/statics.hpp"

namespace brainshift::test {

constexpr double pi = 3.14159265358979323846;

// Round section of given stiffnesses; EA so high that stretching is negligible unless given.
inline BeamSection round_section(double bending, double axial = 1e6, double torsion = 0.0) {
  BeamSection s;
  s.axial = axial;
  s.bending_2 = s.bending_3 = bending;
  s.torsion = torsion > 0.0 ? torsion : bending;
  s.radius = 0.5;
  return s;
}

inline Beam straight_beam(double length, Index elements, const BeamSection& section,
                          const Mat3& orientation = Mat3::Identity()) {
  return Beam(BeamDevice::straight("beam", length, elements, section), Vec3::Zero(), orientation);
}

// All six dofs of a node, or some of them (0-2 translation, 3-5 spin).
inline std::vector<Index> dofs_of(Index node,
                                  std::initializer_list<Index> which = {0, 1, 2, 3, 4, 5}) {
  std::vector<Index> dofs;
  for (const Index k : which) dofs.push_back(6 * node + k);
  return dofs;
}

inline std::vector<Index> joined(std::vector<Index> a, const std::vector<Index>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Clamped at node 0, force and moment on the last node.
inline BeamLoad cantilever(const Beam& beam, const Vec3& force, const Vec3& moment = Vec3::Zero()) {
  BeamLoad load{Eigen::VectorXd::Zero(beam.dof_count()), dofs_of(0)};
  load.force.tail<6>() << force, moment;
  return load;
}

inline Vec3 tip_of(const BeamState& state) { return state.x.row(state.x.rows() - 1); }

inline Vec3 random_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

// Rest state with nodes moved by up to `shift` (mm) and turned by up to `turn` (rad) along each axis.
inline BeamState shaken(const Beam& beam, double shift, double turn, unsigned seed) {
  std::mt19937 random(seed);
  Eigen::VectorXd step(beam.dof_count());
  for (Index i = 0; i < beam.node_count(); ++i) {
    step.segment<3>(6 * i) = random_vector(random, shift);
    step.segment<3>(6 * i + 3) = random_vector(random, turn);
  }
  BeamState state = beam.rest();
  beam.update(state, step);
  return state;
}

// Everything turned by R about the origin and moved by `shift`.
inline BeamState moved(const BeamState& state, const Mat3& R, const Vec3& shift) {
  BeamState result = state;
  for (std::size_t i = 0; i < state.R.size(); ++i) {
    const auto row = Eigen::Index(i);
    result.x.row(row) = (R * state.x.row(row).transpose() + shift).transpose();
    result.R[i] = R * state.R[i];
  }
  return result;
}

// Observed order of convergence between two errors with twice as many elements in the second.
inline double order(double coarse, double fine) { return std::log2(coarse / fine); }

// Errors on a family of meshes.
struct Convergence {
  std::vector<Index> elements;
  std::vector<double> error;

  // Slope of the straight line through log(error) over log(1/h), by least squares.
  double observed_order() const {
    const auto n = Eigen::Index(elements.size());
    Eigen::MatrixXd line(n, 2);
    Eigen::VectorXd logs(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      line.row(i) << 1.0, -std::log(double(elements[std::size_t(i)]));
      logs[i] = std::log(error[std::size_t(i)]);
    }
    return line.colPivHouseholderQr().solve(logs)[1];
  }
  // A row of a table.
  void print(const std::string& name) const {
    std::printf("%-40s", name.c_str());
    for (std::size_t i = 0; i < elements.size(); ++i) {
      std::printf(" | %4d: %.2e", int(elements[i]), error[i]);
    }
    std::printf(" | order %.2f\n", observed_order());
  }
};

// error_of(elements) on each mesh.
template <class F>
Convergence convergence(std::vector<Index> elements, F&& error_of) {
  Convergence result{std::move(elements), {}};
  for (const Index n : result.elements) result.error.push_back(error_of(n));
  return result;
}

// Four meshes, each with twice as many elements.
inline std::vector<Index> four_meshes(Index coarsest) {
  return {coarsest, 2 * coarsest, 4 * coarsest, 8 * coarsest};
}

// How far an observed order may be from the one of theory: what is asked for of four meshes.
constexpr double order_tolerance = 0.15;

}  // namespace brainshift::test
