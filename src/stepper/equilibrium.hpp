// The balance of forces of a scene: everything Newton needs to know at a displacement.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "brainshift/stepper.hpp"
#include "contact/blocks.hpp"
#include "contact/contact_rows.hpp"
#include "contact/reduction.hpp"
#include "fluid/hydrostatics.hpp"
#include "tissue/tissue.hpp"

namespace brainshift {

// Forces at one displacement (N x 3 each, mN), and gaps.
struct Forces {
  Points internal;                  // of tissue and supports: gradient of the stored energy
  double stored = 0.0;              // that energy, uJ
  Eigen::VectorXd jacobians;        // of the tets
  Points external;                  // gravity and fluid, reference taken off
  std::vector<double> heads;        // mm, per compartment
  std::vector<GapSample> gaps;      // per contact row
};

class Equilibrium {
 public:
  explicit Equilibrium(const Scene& scene);

  // Takes up settings; throws Error and changes nothing if they cannot be.
  void configure(const ConstraintSet& constraints, const std::optional<Csf>& csf,
                 const Vec3& gravity);

  const Mesh& mesh() const { return m_tissue.mesh(); }
  void set_threads(int threads) { m_tissue.set_threads(threads); }
  const Tissue& tissue() const { return m_tissue; }
  const Blocks& blocks() const { return *m_blocks; }
  const std::shared_ptr<const Blocks>& blocks_pointer() const { return m_blocks; }
  const ContactRows& contacts() const { return m_contacts; }
  const std::vector<NodeRow>& fixed_rows() const { return m_fixed; }
  const std::optional<Hydrostatics>& fluid() const { return m_fluid; }
  Points positions(const Points& u) const { return mesh().nodes() + u; }

  Forces forces(const Points& u) const;
  // Only the external force; cheap beside the tissue's.
  Points external_force(const Points& u, std::vector<double>* heads = nullptr) const;
  // Work of the external force along the straight way from u0 to u1 (uJ), by Simpson's rule: the
  // fluid's load has no potential where levels differ, its work always exists.
  double external_work(const Points& u0, const Points& external0, const Points& u1, const Points& external1) const;

  // Throws rigid_mode naming a body that nothing holds: it has no quasi-static equilibrium.
  void check_supported() const;

  // Tangent of the stored energy at u, into K.
  void stored_tangent(const Points& u, bool definite, BlockMatrix& K) const;
  // Tangent at u, with the curvature of active contacts; head terms apart.
  void tangent(const Points& u, const Forces& f, const std::vector<double>& multipliers,
               bool definite, BlockMatrix& K) const;
  std::vector<RankOne> head_terms(const Points& u, const Forces& f) const;

  // Forces of contact rows with the given multipliers, on blocks.
  Eigen::VectorXd contact_force(const Forces& f, const std::vector<double>& multipliers) const;
  // mN: below it a force counts as none, with the stiffest modulus and with the softest. The rounding of a
  // residual goes with the first; a load that moves something is to be told from none by the second.
  double force_floor() const { return m_force_floor; }
  double softest_floor() const { return m_softest_floor; }

 private:
  Tissue m_tissue;
  std::vector<Indices> m_adjacency;
  bool m_balanced;
  Vec3 m_reference_gravity;
  std::vector<char> m_silent;        // corners of quadratic tets: no contact rows
  std::optional<Hydrostatics> m_fluid;

  ConstraintSet m_constraints;
  Points m_gravity_force;            // minus the reference's if balanced
  std::shared_ptr<const Blocks> m_blocks;
  std::shared_ptr<const ElementMap> m_map;
  ContactRows m_contacts;
  std::vector<NodeRow> m_fixed;
  Eigen::VectorXd m_springs;         // mN/mm per node
  double m_force_floor = 0.0, m_softest_floor = 0.0;
};

}  // namespace brainshift
