// The fluid's load on the tissue: heads found from the settings, nodal forces, tangent.
//
// The head of each group of compartments (one group each with FluidModel::separate, one for all
// with communicating) is eliminated: at every position of the tissue it is the root h(x) of the
// group's law, docs/theory.md (7), and the tangent carries the rank-one term that goes with it (8).
#pragma once

#include <string>
#include <vector>

#include "brainshift/csf.hpp"
#include "brainshift/mesh.hpp"
#include "linear/block_matrix.hpp"

namespace brainshift {

// K += column * row^T: the dependence of a head on the positions.
struct RankOne {
  Points column, row;  // N x 3
};

class Hydrostatics {
 public:
  // Throws Error: index_out_of_range (faces), surface_not_closed (body), invalid_argument
  // (reference head below a wall's top).
  Hydrostatics(const Mesh& mesh, const Csf& csf, const Vec3& gravity);

  // Checks settings and takes them up; throws Error(fluid_volume) for an amount that cannot be.
  void configure(const Csf& csf, const Vec3& gravity);

  // Heads per compartment at the given positions (N x 3).
  std::vector<double> heads(const Points& x) const;
  // Adds the force on the wetted faces, scaled by `factor` (mN).
  void add_force(const Points& x, const std::vector<double>& heads, double factor,
                 Points& force) const;
  // The reference: full fluid along the reference gravity.
  void add_reference_force(const Points& x, double factor, Points& force) const;

  // Adds -d force/dx at fixed heads (symmetric part of (6)), for the load or minus the reference.
  void add_tangent(const Points& x, const std::vector<double>& heads, const Indices& slot_of,
                   BlockMatrix& K) const;
  void add_reference_tangent(const Points& x, double factor, const Indices& slot_of,
                             BlockMatrix& K) const;
  // Terms of heads that depend on x; empty where heads are given.
  std::vector<RankOne> head_terms(const Points& x, const std::vector<double>& heads) const;

  CompartmentState state(Index compartment, const Points& x,
                         const std::vector<double>& heads) const;
  Eigen::VectorXd nodal_pressure(const Points& x, const std::vector<double>& heads) const;  // kPa
  double weight_per_volume() const { return m_density * m_gravity.norm(); }  // kPa/mm
  double full_head() const { return m_full_head; }

 private:
  struct Body {                          // tissue or wall below a plane
    double volume = 0.0, section = 0.0;  // mm^3, mm^2
  };
  struct Group {  // compartments that share a head
    std::vector<std::size_t> members;
    FluidLaw law = FluidLaw::full;
    double amount = 0.0;
  };
  struct Balance {  // of a group's law: value (mm^3) and derivative with respect to the head
    double value, slope;
  };

  double head_axis_top(const Vec3& up) const;
  void take_gravity(const Csf& csf);
  Body wall_below(std::size_t c, double head) const;
  Body tissue_below(std::size_t c, const Points& x, double head) const;
  double tissue_volume(std::size_t c, const Points& x) const;
  Balance balance(const Group& group, const Points& x, const std::vector<double>& tissue_total,
                  double head) const;
  std::vector<double> tissue_totals(const Points& x) const;
  double solve_head(const Group& group, const Points& x,
                    const std::vector<double>& tissue_total) const;
  bool clips(std::size_t c) const;
  // w: weight of the fluid per volume (kPa/mm), signed.
  void add_faces(const Points& x, const Indices& faces, const Vec3& up, double head, bool clip,
                 double w, Points& force) const;
  void add_face_tangents(const Points& x, const Indices& faces, const Vec3& up, double head,
                         bool clip, double w, const Indices& slot_of, BlockMatrix& K) const;
  void add_quadratic_tangents(const Points& x, const Indices& faces, const Vec3& up, double head,
                              bool clip, double w, const Indices& slot_of, BlockMatrix& K) const;
  // Adds factor * a L_i: the gradient of the volume that the parts bound below the head.
  void add_volume_gradient(const Points& x, const Indices& parts, double head, bool clip,
                           double factor, Points& gradient) const;
  // Adds -w int N_i a: the slope of the force on the faces by the head.
  void add_head_slope(const Points& x, const Indices& faces, double head, bool clip, double w,
                      Points& slope) const;
  void make_parts();
  Indices parts_of(const Indices& faces) const;

  Mesh m_mesh;
  double m_density;
  FluidModel m_model;
  std::vector<Compartment> m_compartments;
  std::vector<bool> m_open;
  std::vector<Group> m_groups;
  std::vector<std::size_t> m_group_of;
  std::vector<double> m_wall_volume, m_rest_tissue;  // mm^3
  Triangles m_parts;                  // the surface in flat triangles; volumes are those they bound
  std::vector<Indices> m_body_parts;  // per compartment

  Vec3 m_gravity, m_up, m_reference_gravity, m_reference_up;
  double m_reference_head = 0.0;  // along the reference axis
  double m_full_head = 0.0;       // along the present axis
  double m_chimney = 0.0;         // mm^2; see solve_head
};

}  // namespace brainshift
