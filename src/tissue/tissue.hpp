// Assembly of the tissue: energy, internal forces and tangent stiffness of all tets.
#pragma once

#include <utility>
#include <vector>

#include "brainshift/material.hpp"
#include "brainshift/mesh.hpp"
#include "linear/block_matrix.hpp"
#include "tissue/tet4.hpp"

namespace brainshift {

// Where the ten lower blocks of each element go in a matrix; made once per matrix pattern.
struct ElementMap {
  std::vector<BlockMatrix::Slot> slots;   // 10 per tet
  std::vector<std::uint16_t> transposed;  // bit k: block k is stored transposed
};

class Tissue {
 public:
  Tissue(const Mesh& mesh, const std::vector<std::pair<Index, Material>>& materials);

  const Mesh& mesh() const { return m_mesh; }
  // Threads that loops over tets may use; no result depends on it.
  void set_threads(int threads) { m_threads = threads; }

  double energy(const Points& u) const;  // uJ
  // Internal force: gradient of the energy (mN), N x 3.
  void internal_force(const Points& u, Points& force) const;
  // slot_of[node]: block of the node in K; nodes tied together share one.
  ElementMap map_elements(const Indices& slot_of, const BlockMatrix& K) const;
  // Force as above, and the tangent added to K. `definite`: each element's nearest positive
  // semidefinite tangent.
  void tangent(const Points& u, bool definite, const ElementMap& map, Points& force,
               BlockMatrix& K) const;
  // m/4 g on each node of a tet: N x 3 for gravity g (mm/s^2).
  Points gravity_force(const Vec3& gravity) const;
  double mass() const;  // kg
  // Lumped mass, N: a quarter of each tet's on its nodes (kg).
  Eigen::VectorXd node_masses() const;

  Eigen::VectorXd jacobians(const Points& u) const;  // M; det F
  // Neighbours of each node through tets, sorted.
  std::vector<Indices> node_adjacency() const;
  double stiffness_scale() const { return m_scale; }  // largest Young's modulus, kPa

 private:
  struct Part {  // tets that share a material
    Material material;
    Indices tets;
  };
  using NodalForces = Eigen::Matrix<double, 4, 3, Eigen::RowMajor>;   // of one tet

  // Calls work(law, its constants, i) for the tets i = from .. to - 1 of a part, in chunks that the
  // threads share.
  template <class Work>
  void for_tets(const Part& part, Index from, Index to, const Work& work) const;
  // Calls work(law, its constants, tet) for all tets.
  template <class Work>
  void for_all_tets(const Work& work) const;
  void scatter(const std::vector<NodalForces>& forces, Points& nodal) const;
  Mesh m_mesh;
  std::vector<Part> m_parts;
  std::vector<Tet4> m_elements;
  double m_scale = 0.0;
  int m_threads = 1;
};

}  // namespace brainshift
