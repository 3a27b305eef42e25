// The tissue's tangent: blocks of the elements into the matrix.
#include <algorithm>
#include <array>
#include <string>

#include <Eigen/Eigenvalues>

#include "brainshift/error.hpp"
#include "material/mat9.hpp"
#include "tissue/tissue_loops.hpp"

namespace brainshift {

ElementMap Tissue::map_elements(const Indices& slot_of, const BlockMatrix& K) const {
  ElementMap map;
  const int n = nodes_per_tet();
  map.slots.reserve(std::size_t(n * (n + 1) / 2) * std::size_t(m_mesh.tet_count()));
  map.transposed.reserve(std::size_t(m_mesh.tet_count()));
  for (Index t = 0; t < m_mesh.tet_count(); ++t) {
    std::uint64_t turned = 0;
    int bit = 0;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b <= a; ++b, ++bit) {
        const Index i = slot_of[std::size_t(nodes_of(t)[a])];
        const Index j = slot_of[std::size_t(nodes_of(t)[b])];
        map.slots.push_back(K.slot(std::max(i, j), std::min(i, j)));
        if (i < j) turned |= std::uint64_t(1) << bit;
        if (i == j && a != b) {
          throw Error(ErrorCode::conflicting_constraints,
                      "two nodes of tet " + std::to_string(t) + " are tied to each other");
        }
      }
    }
    map.transposed.push_back(turned);
  }
  if (!m_volume.empty()) map.patches = m_volume.map(slot_of, K);
  return map;
}

namespace {

// K_ab += V sum_jl  dN_a/dX_j  dP_ij/dF_kl  dN_b/dX_l  (docs/theory.md (3)).
// A is 9 x 9 over column-major vectors: rows (i, j) -> i + 3 j.
template <class Element>
void add_to_blocks(const Mat9& A, const Element& e, int q, Mat3 (&blocks)[Element::blocks]) {
  constexpr int n = Element::nodes;
  const auto& gradients = e.gradients[q];
  Eigen::Matrix<double, 9, 3 * n> AB;  // column 3 b + k: dP for u_b along k
  for (int b = 0; b < n; ++b) {
    AB.template middleCols<3>(3 * b) = A.middleCols<3>(0) * gradients(b, 0) +
                                       A.middleCols<3>(3) * gradients(b, 1) +
                                       A.middleCols<3>(6) * gradients(b, 2);
  }
  AB *= e.volumes[q];
  int k = 0;
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b <= a; ++b, ++k) {
      blocks[k] += gradients(a, 0) * AB.template block<3, 3>(0, 3 * b) +
                   gradients(a, 1) * AB.template block<3, 3>(3, 3 * b) +
                   gradients(a, 2) * AB.template block<3, 3>(6, 3 * b);
    }
  }
}

template <class Element>
void add_to_blocks(const ModalTangent& A, const Element& e, int q, Mat3 (&blocks)[Element::blocks]) {
  constexpr int n = Element::nodes;
  const auto& gradients = e.gradients[q];
  std::array<Eigen::Matrix<double, 3, n>, 4> moved, weighted;   // mode times gradient, by node
  for (std::size_t m = 0; m < moved.size(); ++m) {
    moved[m] = A.mode[m] * gradients.transpose();
    weighted[m] = e.volumes[q] * A.weight[m] * moved[m];
  }
  int k = 0;
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b <= a; ++b, ++k) {
      blocks[k].diagonal().array() += e.volumes[q] * A.diagonal * gradients.row(a).dot(gradients.row(b));
      for (std::size_t m = 0; m < moved.size(); ++m) {
        blocks[k].noalias() += weighted[m].col(a) * moved[m].col(b).transpose();
      }
    }
  }
}

void add_blocks(const Mat3* blocks, int count, const ElementMap& map, Index t, BlockMatrix& K) {
  const BlockMatrix::Slot* slot = &map.slots[std::size_t(t) * std::size_t(count)];
  for (int k = 0; k < count; ++k) {
    if (map.transposed[std::size_t(t)] >> k & 1u) {
      K.add(slot[k], blocks[k].transpose());
    } else {
      K.add(slot[k], blocks[k]);
    }
  }
}

void remove_negative_eigenvalues(Mat9& A) {
  const Eigen::SelfAdjointEigenSolver<Mat9> eigen(A);
  const Vec9 kept = eigen.eigenvalues().cwiseMax(0.0);
  A = eigen.eigenvectors() * kept.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

void Tissue::tangent(const Points& u, bool definite, const ElementMap& map, BlockMatrix& K) const {
  std::visit([&](const auto& elements) { element_tangents(elements, u, definite, map, K); }, *m_elements);
}

template <class Element>
void Tissue::element_tangents(const std::vector<Element>& elements, const Points& u, bool definite,
                              const ElementMap& map, BlockMatrix& K) const {
  std::vector<Mat3> gradients;  // of the averaged volume, with the pressure that goes with it
  std::vector<double> pressures;
  if (!m_volume.empty()) pressures = m_volume.pressures(volume_measures(u, &gradients));
  struct Blocks {
    Mat3 block[Element::blocks];
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
        const Element& e = elements[std::size_t(t)];
        auto& block = blocks[std::size_t(i - from)].block;
        for (Mat3& b : block) b.setZero();
        for (int q = 0; q < Element::points; ++q) {
          const Mat3 G = e.displacement_gradient(u, nodes_of(t), q);
          if (law.modal_tangent && pressures.empty()) {
            ModalTangent A;
            law.modal_tangent(lame, G, definite, A);
            add_to_blocks(A, e, q, block);
            continue;
          }
          Mat3 P;
          Mat9 A;
          law.tangent(lame, G, definite, P, A);
          if (!pressures.empty()) {
            A += pressures[std::size_t(t)] * law.volume(G).hessian;
            if (definite) remove_negative_eigenvalues(A);
          }
          add_to_blocks(A, e, q, block);
        }
      });
      for (Index i = from; i < to; ++i) {
        const Index t = part.tets[std::size_t(i)];
        add_blocks(blocks[std::size_t(i - from)].block, Element::blocks, map, t, K);
      }
    }
  }
  if constexpr (Element::points == 1) {
    if (!m_volume.empty()) m_volume.add_tangent(gradients, elements, map.patches, K);
  }
}

}  // namespace brainshift
