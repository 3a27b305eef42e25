#include "tissue/tissue.hpp"

#include <algorithm>
#include <string>

#include <Eigen/LU>

#include "brainshift/error.hpp"
#include "material/mat9.hpp"
#include "material/registry.hpp"
#include "threads/for_chunks.hpp"

namespace brainshift {

Tissue::Tissue(const Mesh& mesh, const std::vector<std::pair<Index, Material>>& materials)
    : m_mesh(mesh) {
  for (const auto& [region, material] : materials) {
    for (const auto& other : materials) {
      if (&other.second != &material && other.first == region) {
        throw Error(ErrorCode::invalid_argument,
                    "region " + std::to_string(region) + " is given two materials");
      }
    }
    m_parts.push_back({material, {}});
    m_scale = std::max(m_scale, material.young());
  }
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const Index region = mesh.regions()[std::size_t(t)];
    const auto found = std::find_if(materials.begin(), materials.end(),
                                    [&](const auto& m) { return m.first == region; });
    if (found == materials.end()) {
      throw Error(ErrorCode::invalid_argument, "tet " + std::to_string(t) + " is of region " +
                                                   std::to_string(region) +
                                                   ", which has no material");
    }
    m_parts[std::size_t(found - materials.begin())].tets.push_back(t);
    m_elements.emplace_back(mesh.nodes(), mesh.tets(), t);
  }
}

namespace {

// Tets per chunk: long enough to be worth a thread, short enough for what a chunk keeps to stay in
// the cache.
constexpr Index tets_per_chunk = 512;

}  // namespace

template <class Work>
void Tissue::for_tets(const Part& part, Index from, Index to, const Work& work) const {
  const LawFunctions& law = law_functions(part.material.law());
  const Lame lame{part.material.mu(), part.material.lambda()};
  const Index chunks = (to - from + tets_per_chunk - 1) / tets_per_chunk;
  for_chunks(m_threads, chunks, [&](Index c) {
    const ChunkRange range = chunk_range(to - from, chunks, c);
    for (Index i = range.from; i < range.to; ++i) work(law, lame, from + i);
  });
}

template <class Work>
void Tissue::for_all_tets(const Work& work) const {
  for (const Part& part : m_parts) {
    for_tets(part, 0, Index(part.tets.size()),
             [&](const LawFunctions& law, const Lame& lame, Index i) {
               work(law, lame, part.tets[std::size_t(i)]);
             });
  }
}

double Tissue::energy(const Points& u) const {
  std::vector<double> energies(m_elements.size());
  for_all_tets([&](const LawFunctions& law, const Lame& lame, Index t) {
    const Tet4& e = m_elements[std::size_t(t)];
    energies[std::size_t(t)] =
        e.volume * law.energy(lame, e.displacement_gradient(u, m_mesh.tets(), t));
  });
  double sum = 0.0;   // in the order of the tets, whatever the threads
  for (double energy : energies) sum += energy;
  return sum;
}

void Tissue::scatter(const std::vector<NodalForces>& forces, Points& nodal) const {
  nodal.setZero(m_mesh.node_count(), 3);
  for (std::size_t t = 0; t < forces.size(); ++t) {
    for (int a = 0; a < 4; ++a) nodal.row(m_mesh.tets()(Index(t), a)) += forces[t].row(a);
  }
}

void Tissue::internal_force(const Points& u, Points& force) const {
  std::vector<NodalForces> forces(m_elements.size());
  for_all_tets([&](const LawFunctions& law, const Lame& lame, Index t) {
    const Tet4& e = m_elements[std::size_t(t)];
    const Mat3 P = law.stress(lame, e.displacement_gradient(u, m_mesh.tets(), t));
    forces[std::size_t(t)] = e.volume * e.gradients * P.transpose();
  });
  scatter(forces, force);
}

ElementMap Tissue::map_elements(const Indices& slot_of, const BlockMatrix& K) const {
  ElementMap map;
  map.slots.reserve(std::size_t(10) * m_elements.size());
  map.transposed.reserve(m_elements.size());
  for (Index t = 0; t < m_mesh.tet_count(); ++t) {
    std::uint16_t turned = 0;
    int bit = 0;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b <= a; ++b, ++bit) {
        const Index i = slot_of[std::size_t(m_mesh.tets()(t, a))];
        const Index j = slot_of[std::size_t(m_mesh.tets()(t, b))];
        map.slots.push_back(K.slot(std::max(i, j), std::min(i, j)));
        if (i < j) turned = std::uint16_t(turned | (1u << bit));
        if (i == j && a != b) {
          throw Error(ErrorCode::conflicting_constraints,
                      "two nodes of tet " + std::to_string(t) + " are tied to each other");
        }
      }
    }
    map.transposed.push_back(turned);
  }
  return map;
}

namespace {

// K_ab = V sum_jl  dN_a/dX_j  dP_ij/dF_kl  dN_b/dX_l  (docs/theory.md (3)).
// A is 9 x 9 over column-major vectors: rows (i, j) -> i + 3 j.
void element_blocks(const Mat9& A, const Tet4& e, Mat3 (&blocks)[10]) {
  Eigen::Matrix<double, 9, 12> AB;  // column 3 b + k: dP for u_b along k
  for (int b = 0; b < 4; ++b) {
    AB.middleCols<3>(3 * b) = A.middleCols<3>(0) * e.gradients(b, 0) +
                              A.middleCols<3>(3) * e.gradients(b, 1) +
                              A.middleCols<3>(6) * e.gradients(b, 2);
  }
  AB *= e.volume;
  int k = 0;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b <= a; ++b, ++k) {
      blocks[k] = e.gradients(a, 0) * AB.block<3, 3>(0, 3 * b) +
                  e.gradients(a, 1) * AB.block<3, 3>(3, 3 * b) +
                  e.gradients(a, 2) * AB.block<3, 3>(6, 3 * b);
    }
  }
}

void add_blocks(const Mat3 (&blocks)[10], const ElementMap& map, Index t, BlockMatrix& K) {
  const BlockMatrix::Slot* slot = &map.slots[std::size_t(t) * 10];
  for (int k = 0; k < 10; ++k) {
    if (map.transposed[std::size_t(t)] >> k & 1u) {
      K.add(slot[k], blocks[k].transpose());
    } else {
      K.add(slot[k], blocks[k]);
    }
  }
}

}  // namespace

void Tissue::tangent(const Points& u, bool definite, const ElementMap& map, Points& force,
                     BlockMatrix& K) const {
  std::vector<NodalForces> forces(m_elements.size());
  struct Blocks {
    Mat3 block[10];
  };
  // Rounds of tets: computed by all threads, then added by one, in the order of the tets.
  constexpr Index round = 8 * tets_per_chunk;
  std::vector<Blocks> blocks(std::size_t(std::min(round, m_mesh.tet_count())));
  for (const Part& part : m_parts) {
    const auto count = Index(part.tets.size());
    for (Index from = 0; from < count; from += round) {
      const Index to = std::min(count, from + round);
      for_tets(part, from, to, [&](const LawFunctions& law, const Lame& lame, Index i) {
        const Index t = part.tets[std::size_t(i)];
        const Tet4& e = m_elements[std::size_t(t)];
        Mat3 P;
        Mat9 A;
        law.tangent(lame, e.displacement_gradient(u, m_mesh.tets(), t), definite, P, A);
        forces[std::size_t(t)] = e.volume * e.gradients * P.transpose();
        element_blocks(A, e, blocks[std::size_t(i - from)].block);
      });
      for (Index i = from; i < to; ++i) {
        const Index t = part.tets[std::size_t(i)];
        add_blocks(blocks[std::size_t(i - from)].block, map, t, K);
      }
    }
  }
  scatter(forces, force);
}

Points Tissue::gravity_force(const Vec3& gravity) const {
  Points force = Points::Zero(m_mesh.node_count(), 3);
  for (const Part& part : m_parts) {
    for (Index t : part.tets) {
      const Vec3 quarter =
          0.25 * part.material.density() * m_elements[std::size_t(t)].volume * gravity;
      for (int a = 0; a < 4; ++a) force.row(m_mesh.tets()(t, a)) += quarter.transpose();
    }
  }
  return force;
}

double Tissue::mass() const {
  double sum = 0.0;
  for (const Part& part : m_parts) {
    for (Index t : part.tets) sum += part.material.density() * m_elements[std::size_t(t)].volume;
  }
  return sum;
}

Eigen::VectorXd Tissue::node_masses() const {
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(m_mesh.node_count());
  for (const Part& part : m_parts) {
    for (Index t : part.tets) {
      const double quarter = 0.25 * part.material.density() * m_elements[std::size_t(t)].volume;
      for (int a = 0; a < 4; ++a) masses[m_mesh.tets()(t, a)] += quarter;
    }
  }
  return masses;
}

Eigen::VectorXd Tissue::jacobians(const Points& u) const {
  Eigen::VectorXd result(m_mesh.tet_count());
  for_all_tets([&](const LawFunctions&, const Lame&, Index t) {
    const Tet4& e = m_elements[std::size_t(t)];
    result[t] = 1.0 + volume_change(e.displacement_gradient(u, m_mesh.tets(), t));
  });
  return result;
}

std::vector<Indices> Tissue::node_adjacency() const {
  std::vector<Indices> near(std::size_t(m_mesh.node_count()));
  for (Index t = 0; t < m_mesh.tet_count(); ++t) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        if (a != b) near[std::size_t(m_mesh.tets()(t, a))].push_back(m_mesh.tets()(t, b));
      }
    }
  }
  for (Indices& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return near;
}

}  // namespace brainshift
