#include "tissue/nodal_volume.hpp"

#include <algorithm>

namespace brainshift {

NodalVolume::NodalVolume(const Mesh& mesh, const std::vector<Tet4>& elements,
                         const std::vector<Indices>& tets_of, const std::vector<double>& lambda) {
  for (const Tet4& e : elements) m_volumes.push_back(e.volume());
  for (std::size_t m = 0; m < tets_of.size(); ++m) {
    std::vector<Indices> around(std::size_t(mesh.node_count()));
    for (Index t : tets_of[m]) {
      for (int a = 0; a < 4; ++a) around[std::size_t(mesh.tets()(t, a))].push_back(t);
    }
    for (const Indices& tets : around) {
      if (tets.empty()) continue;
      Patch patch{lambda[m], 0.0, {}, {}};
      for (Index t : tets) {
        patch.volume += 0.25 * m_volumes[std::size_t(t)];
        for (int a = 0; a < 4; ++a) patch.nodes.push_back(mesh.tets()(t, a));
      }
      std::sort(patch.nodes.begin(), patch.nodes.end());
      patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
      for (Index t : tets) {
        Member member{t, {}};
        for (int a = 0; a < 4; ++a) {
          const auto place =
              std::lower_bound(patch.nodes.begin(), patch.nodes.end(), mesh.tets()(t, a));
          member.node[a] = int(place - patch.nodes.begin());
        }
        patch.members.push_back(member);
      }
      m_patches.push_back(std::move(patch));
    }
  }
}

double NodalVolume::average(const Patch& patch, const std::vector<double>& theta) const {
  double sum = 0.0;
  for (const Member& member : patch.members) {
    sum += 0.25 * m_volumes[std::size_t(member.tet)] * theta[std::size_t(member.tet)];
  }
  return sum / patch.volume;
}

double NodalVolume::energy(const std::vector<double>& theta) const {
  double sum = 0.0;
  for (const Patch& patch : m_patches) {
    const double mean = average(patch, theta);
    sum += 0.5 * patch.lambda * patch.volume * mean * mean;
  }
  return sum;
}

std::vector<double> NodalVolume::pressures(const std::vector<double>& theta) const {
  std::vector<double> pressures(theta.size(), 0.0);
  for (const Patch& patch : m_patches) {
    const double share = 0.25 * patch.lambda * average(patch, theta);
    for (const Member& member : patch.members) pressures[std::size_t(member.tet)] += share;
  }
  return pressures;
}

void NodalVolume::add_tangent(const std::vector<Mat3>& gradients, const std::vector<Tet4>& elements,
                              const PatchMap& map, BlockMatrix& K) const {
  std::size_t slot = 0;
  std::vector<Vec3> b;
  for (const Patch& patch : m_patches) {
    b.assign(patch.nodes.size(), Vec3::Zero());
    for (const Member& member : patch.members) {
      const auto t = std::size_t(member.tet);
      const Eigen::Matrix<double, 4, 3> part =
          0.25 * m_volumes[t] * elements[t].gradients[0] * gradients[t].transpose();
      for (int a = 0; a < 4; ++a) b[std::size_t(member.node[a])] += part.row(a).transpose();
    }
    const double factor = patch.lambda / patch.volume;
    for (std::size_t i = 0; i < b.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j, ++slot) {
        Mat3 block = factor * b[i] * b[j].transpose();
        if (map.places[slot] == PatchMap::Place::transposed) block.transposeInPlace();
        if (map.places[slot] == PatchMap::Place::both) block += block.transpose().eval();
        K.add(map.slots[slot], block);
      }
    }
  }
}

PatchMap NodalVolume::map(const Indices& slot_of, const BlockMatrix& K) const {
  PatchMap map;
  for (const Patch& patch : m_patches) {
    for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const Index row = slot_of[std::size_t(patch.nodes[i])];
        const Index col = slot_of[std::size_t(patch.nodes[j])];
        map.slots.push_back(K.slot(std::max(row, col), std::min(row, col)));
        map.places.push_back(row < col             ? PatchMap::Place::transposed
                             : row > col || i == j ? PatchMap::Place::straight
                                                   : PatchMap::Place::both);
      }
    }
  }
  return map;
}

void NodalVolume::extend(std::vector<Indices>& adjacency) const {
  for (const Patch& patch : m_patches) {
    for (Index i : patch.nodes) {
      for (Index j : patch.nodes) {
        if (i != j) adjacency[std::size_t(i)].push_back(j);
      }
    }
  }
}

}  // namespace brainshift
