#include "tissue/tissue.hpp"

#include <algorithm>
#include <string>

#include <Eigen/LU>

#include "brainshift/error.hpp"
#include "material/registry.hpp"

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

double Tissue::energy(const Points& u) const {
  double sum = 0.0;
  for (const Part& part : m_parts) {
    const LawFunctions& law = law_functions(part.material.law());
    const Lame lame{part.material.mu(), part.material.lambda()};
    for (Index t : part.tets) {
      const Tet4& e = m_elements[std::size_t(t)];
      sum += e.volume * law.energy(lame, e.displacement_gradient(u, m_mesh.tets(), t));
    }
  }
  return sum;
}

void Tissue::internal_force(const Points& u, Points& force) const {
  force.setZero(m_mesh.node_count(), 3);
  for (const Part& part : m_parts) {
    const LawFunctions& law = law_functions(part.material.law());
    const Lame lame{part.material.mu(), part.material.lambda()};
    for (Index t : part.tets) {
      const Tet4& e = m_elements[std::size_t(t)];
      const Mat3 P = law.stress(lame, e.displacement_gradient(u, m_mesh.tets(), t));
      for (int a = 0; a < 4; ++a) {
        force.row(m_mesh.tets()(t, a)) +=
            (e.volume * (P * e.gradients.row(a).transpose())).transpose();
      }
    }
  }
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

}  // namespace

void Tissue::tangent(const Points& u, bool definite, const ElementMap& map, Points& force,
                     BlockMatrix& K) const {
  force.setZero(m_mesh.node_count(), 3);
  Mat3 P, blocks[10];
  Mat9 A;
  for (const Part& part : m_parts) {
    const LawFunctions& law = law_functions(part.material.law());
    const Lame lame{part.material.mu(), part.material.lambda()};
    for (Index t : part.tets) {
      const Tet4& e = m_elements[std::size_t(t)];
      law.tangent(lame, e.displacement_gradient(u, m_mesh.tets(), t), definite, P, A);
      for (int a = 0; a < 4; ++a) {
        force.row(m_mesh.tets()(t, a)) +=
            (e.volume * (P * e.gradients.row(a).transpose())).transpose();
      }
      element_blocks(A, e, blocks);
      const BlockMatrix::Slot* slot = &map.slots[std::size_t(t) * 10];
      for (int k = 0; k < 10; ++k) {
        if (map.transposed[std::size_t(t)] >> k & 1u) {
          K.add(slot[k], blocks[k].transpose());
        } else {
          K.add(slot[k], blocks[k]);
        }
      }
    }
  }
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
  for (Index t = 0; t < m_mesh.tet_count(); ++t) {
    result[t] =
        1.0 + volume_change(m_elements[std::size_t(t)].displacement_gradient(u, m_mesh.tets(), t));
  }
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
