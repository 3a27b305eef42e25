// Assembly of the tissue: energy, internal forces and tangent stiffness of all tets.
#pragma once

#include <cstdint>
#include <map>
#include <limits>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "brainshift/material.hpp"
#include "brainshift/mesh.hpp"
#include "linear/block_matrix.hpp"
#include "tissue/nodal_volume.hpp"
#include "tissue/tet_element.hpp"

namespace brainshift {

// Where the lower blocks of each element go in a matrix; made once per matrix pattern.
struct ElementMap {
  std::vector<BlockMatrix::Slot> slots;   // 10 or 55 per tet
  std::vector<std::uint64_t> transposed;  // bit k: block k is stored transposed
  PatchMap patches;                       // of nodes that share a volume change
};

// Of all tets at some displacement.
struct TissueResponse {
  Points force;                // mN, N x 3; gradient of the energy
  double energy = 0.0;         // uJ
  Eigen::VectorXd jacobians;   // M; Tissue::jacobians
};

class Tissue {
 public:
  // Throws invalid_argument: a region with no material or with two; nodal volumes on quadratic tets.
  Tissue(const Mesh& mesh, const std::vector<std::pair<Index, Material>>& materials,
         VolumeStrain volume_strain = VolumeStrain::element);

  const Mesh& mesh() const { return m_mesh; }
  const Material& material_of(Index t) const;
  bool averages_volume() const { return !m_volume.empty(); }
  // Threads that loops over tets may use; no result depends on it.
  void set_threads(int threads) { m_threads = threads; }

  double energy(const Points& u) const;  // uJ
  TissueResponse response(const Points& u) const;
  // slot_of[node]: block of the node in K; nodes tied together share one.
  ElementMap map_elements(const Indices& slot_of, const BlockMatrix& K) const;
  // Added to K. `definite`: each element's nearest positive semidefinite tangent.
  void tangent(const Points& u, bool definite, const ElementMap& map, BlockMatrix& K) const;
  // Consistent with the shape functions: N x 3 for gravity g (mm/s^2).
  Points gravity_force(const Vec3& gravity) const;
  double mass() const;  // kg
  // Lumped mass, N (kg): a quarter of a linear tet's on each node; of a quadratic one 1/36 on each
  // corner and 4/27 on each edge, in the ratio of the squared shape functions (Hinton, Rock,
  // Zienkiewicz 1976), where row sums would be negative.
  Eigen::VectorXd node_masses() const;

  // M; det F, of quadratic tets the smallest at their points of quadrature.
  Eigen::VectorXd jacobians(const Points& u) const;
  // Neighbours of each node in the stiffness, sorted.
  std::vector<Indices> node_adjacency() const;
  double stiffest() const { return m_stiffest; }   // largest and smallest Young's modulus, kPa
  double softest() const { return m_softest; }

 private:
  struct Part {  // tets that share a material
    Material material;
    Indices tets;
  };
  using Elements = std::variant<std::vector<Tet4>, std::vector<Tet10>>;

  int nodes_per_tet() const { return m_mesh.is_quadratic() ? 10 : 4; }
  const Index* nodes_of(Index t) const { return &m_connectivity(t, 0); }
  // Calls work(law, its constants, i) for the tets i = from .. to - 1 of a part, in chunks that the
  // threads share. Constants: without the part of the volume that nodes average.
  template <class Work>
  void for_tets(const Part& part, Index from, Index to, const Work& work) const;
  // Calls work(law, its constants, tet) for all tets.
  template <class Work>
  void for_all_tets(const Work& work) const;
  template <class Rows>
  void scatter(const std::vector<Rows>& forces, Points& nodal) const;
  template <class Element>
  TissueResponse response(const std::vector<Element>& elements, const Points& u) const;
  template <class Element>
  void element_tangents(const std::vector<Element>& elements, const Points& u, bool definite,
                        const ElementMap& map, BlockMatrix& K) const;
  void make_elements();
  void average_volumes();
  Lame element_constants(const Part& part) const;
  std::vector<double> volume_measures(const Points& u,
                                      std::vector<Mat3>* gradients = nullptr) const;
  Eigen::VectorXd linear_volumes(Index t) const;
  Eigen::VectorXd quadratic_volumes(Index t) const;
  double volume_of(Index t) const;

  Mesh m_mesh;
  Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> m_connectivity;
  std::vector<Part> m_parts;
  std::map<Index, std::size_t> m_part_of;  // by region
  // Shared by copies, which never change them. (A variant of vectors must not be copied either: out of
  // memory, libstdc++ 12 visits one that holds nothing.)
  std::shared_ptr<const Elements> m_elements;
  NodalVolume m_volume;  // empty unless volumes are averaged at nodes
  double m_stiffest = 0.0, m_softest = std::numeric_limits<double>::infinity();
  int m_threads = 1;
};

}  // namespace brainshift
