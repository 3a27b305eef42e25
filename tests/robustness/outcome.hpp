// What a solve may end in: balance with a certificate that holds, or a status that says why not.
#pragma once

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "support/expect_error.hpp"
#include "support/scenes.hpp"

namespace brainshift::test {

inline void expect_converged(const SolveReport& r, const StepperOptions& options = {}) {
  EXPECT_TRUE(r.converged()) << to_string(r.status) << ": " << r.message;
  EXPECT_LE(r.residual, options.residual_tolerance);
  EXPECT_LE(r.complementarity, options.complementarity_tolerance);
  EXPECT_GT(r.smallest_jacobian, 0.0);
  EXPECT_TRUE(std::isfinite(r.energy));
  EXPECT_EQ(r.load_factor, 1.0);
}

// No balance, and said so: a part of the load that was reached, a sentence, nothing that is NaN.
inline void expect_failed(const SolveReport& r) {
  EXPECT_TRUE(r.status == Status::no_equilibrium || r.status == Status::not_converged)
      << to_string(r.status);
  EXPECT_FALSE(r.message.empty());
  EXPECT_FALSE(std::isnan(r.residual));
  EXPECT_GE(r.load_factor, 0.0);
  EXPECT_LT(r.load_factor, 1.0);
}

inline void expect_converged_or_failed(const SolveReport& r) {
  r.converged() ? expect_converged(r) : expect_failed(r);
}

// All that shows of a state, bit by bit.
struct ShownState {
  Points u, v, internal, external;
  std::vector<double> contact;

  explicit ShownState(const Stepper& s)
      : u(s.displacement()),
        v(s.velocity()),
        internal(s.internal_force()),
        external(s.external_force()) {
    for (const ConstraintGroup& group : s.constraints().groups()) {
      const ContactState c = s.contact(group.id);
      contact.insert(contact.end(), c.multiplier.data(), c.multiplier.data() + c.multiplier.size());
    }
  }
  bool operator==(const ShownState& other) const {
    return same_bits(u, other.u) && same_bits(v, other.v) && same_bits(internal, other.internal) &&
           same_bits(external, other.external) && contact == other.contact;
  }
};

inline Indices bottom(const Mesh& mesh) {
  return nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
}

// Cube of 20 mm, free of load, under `gravity`, held at its base.
inline Scene cube_on_base(Law law, const Vec3& gravity = {0.0, 0.0, -standard_gravity},
                          int cells = 2, double poisson = 0.45) {
  Scene scene{make_mesh(make_box({20, 20, 20}, cells, cells, cells)),
              {{0, Material(law, 6.0, poisson, tissue_density)}},
              gravity};
  scene.balanced_reference = false;
  scene.constraints.fix("base", bottom(scene.mesh));
  return scene;
}

// uJ; mechanical energy of a scene without fluid: strain, motion, and height in gravity.
inline double total_energy(const Stepper& s, const SolveReport& r) {
  return r.energy + r.kinetic_energy - s.gravity_force().cwiseProduct(s.displacement()).sum();
}

inline double largest(const Points& p) { return p.rowwise().norm().maxCoeff(); }

}  // namespace brainshift::test
