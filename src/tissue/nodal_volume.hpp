// Linear tets against locking: the change of volume is averaged around each node (Bonet & Burton
// 1998), here on the level of the energy, so that forces have a potential and the tangent is
// symmetric. With theta the law's own measure of the change of volume and n the nodes,
//   E = sum_e V_e psi(mu, 0) + sum_n V_n lambda/2 theta_n^2,
//   V_n = sum_e V_e / 4,   theta_n = sum_e (V_e / 4) theta_e / V_n   over the tets around n.
// docs/theory.md (22). Averages stay within a material: pressure may jump where lambda does.
#pragma once

#include <vector>

#include "linear/block_matrix.hpp"
#include "material/law.hpp"
#include "tissue/tet_element.hpp"

namespace brainshift {

// Where the lower blocks of each patch go: those of a patch with m nodes, m (m + 1) / 2.
struct PatchMap {
  enum class Place : char { straight, transposed, both };  // both: of two nodes tied to each other
  std::vector<BlockMatrix::Slot> slots;
  std::vector<Place> places;
};

class NodalVolume {
 public:
  NodalVolume() = default;
  // tets_of: the tets of each material; lambda: of each.
  NodalVolume(const Mesh& mesh, const std::vector<Tet4>& elements,
              const std::vector<Indices>& tets_of, const std::vector<double>& lambda);

  bool empty() const { return m_patches.empty(); }
  // theta: one per tet, M. The energy of the averages (uJ).
  double energy(const std::vector<double>& theta) const;
  // What multiplies theta's gradient in the stress of each tet: its mean pressure, M (kPa).
  std::vector<double> pressures(const std::vector<double>& theta) const;
  // Adds sum_n lambda / V_n b_n b_n^T, b_n the gradient of V_n theta_n. gradients: of theta by F, M.
  void add_tangent(const std::vector<Mat3>& gradients, const std::vector<Tet4>& elements,
                   const PatchMap& map, BlockMatrix& K) const;
  PatchMap map(const Indices& slot_of, const BlockMatrix& K) const;
  // Adds the nodes that share a patch to each other's lists.
  void extend(std::vector<Indices>& adjacency) const;

 private:
  struct Member {
    Index tet;
    int node[4];  // places of its nodes among the patch's
  };
  struct Patch {
    double lambda, volume;  // kPa, mm^3
    Indices nodes;
    std::vector<Member> members;
  };
  double average(const Patch& patch, const std::vector<double>& theta) const;

  std::vector<Patch> m_patches;
  std::vector<double> m_volumes;  // of tets, mm^3
};

}  // namespace brainshift
