// Bodies in fluid for the tests of this folder.
#pragma once

#include <random>

#include "fluid/hydrostatics.hpp"
#include "support/scenes.hpp"

namespace brainshift::test {

const Vec3 gravity_down(0.0, 0.0, -standard_gravity);
constexpr double weight = fluid_density * standard_gravity;  // kPa/mm

// A ball of tissue in a larger spherical cavity, both around the origin.
struct BallInCavity {
  Mesh mesh;
  Csf csf;
  explicit BallInCavity(double radius = 30.0, int cells = 6, double cavity = 40.0,
                        bool quadratic = false)
      : mesh(quadratic ? make_mesh(make_ball(radius, cells)).quadratic()
                       : make_mesh(make_ball(radius, cells))),
        csf(fluid_density, FluidModel::separate,
            {make_compartment("all", make_icosphere(cavity, 3), all_faces(mesh))}) {}
};

// Positions pushed off their places, as a deformed body's would be.
inline Points shaken(const Mesh& mesh, double by, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-by, by);
  Points x = mesh.nodes();
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += shift(random);
  return x;
}

inline Points force_at(const Hydrostatics& fluid, const Points& x,
                       const std::vector<double>& heads) {
  Points force = Points::Zero(x.rows(), 3);
  fluid.add_force(x, heads, 1.0, force);
  return force;
}

// Volume of the part of the tets below a level height, by cutting each tet: independent of the
// library's own way over the surface. Also its centre (times the volume).
inline double volume_below(const Mesh& mesh, const Points& x, double head, Vec3* moment = nullptr) {
  double total = 0.0;
  if (moment) moment->setZero();
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const double v = std::abs((b - a).dot((c - a).cross(d - a))) / 6.0;
    total += v;
    if (moment) *moment += v * 0.25 * (a + b + c + d);
  };
  for (Eigen::Index t = 0; t < mesh.tets().rows(); ++t) {
    std::vector<Vec3> low, high;
    for (int a = 0; a < 4; ++a) {
      const Vec3 p = x.row(mesh.tets()(t, a)).transpose();
      (p.z() <= head ? low : high).push_back(p);
    }
    const auto cut = [head](const Vec3& p, const Vec3& q) -> Vec3 {
      return p + (head - p.z()) / (q.z() - p.z()) * (q - p);
    };
    if (low.size() == 4) {
      add(low[0], low[1], low[2], low[3]);
    } else if (low.size() == 1) {
      add(low[0], cut(low[0], high[0]), cut(low[0], high[1]), cut(low[0], high[2]));
    } else if (low.size() == 2) {  // a wedge: three tets
      const Vec3 a[2] = {low[0], low[1]};
      Vec3 c[2][2];
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) c[i][j] = cut(low[std::size_t(i)], high[std::size_t(j)]);
      add(a[0], a[1], c[0][0], c[0][1]);
      add(a[1], c[0][0], c[0][1], c[1][1]);
      add(a[1], c[0][0], c[1][0], c[1][1]);
    } else if (low.size() == 3) {
      const Vec3 c[3] = {cut(low[0], high[0]), cut(low[1], high[0]), cut(low[2], high[0])};
      add(low[0], low[1], low[2], c[0]);
      add(low[1], low[2], c[0], c[1]);
      add(low[2], c[0], c[1], c[2]);
    }
  }
  return total;
}

}  // namespace brainshift::test
