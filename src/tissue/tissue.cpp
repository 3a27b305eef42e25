#include "tissue/tissue.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "brainshift/error.hpp"
#include "material/mat9.hpp"
#include "material/registry.hpp"
#include "mesh/edge_nodes.hpp"
#include "mesh/quadratic_tet.hpp"
#include "tissue/tissue_loops.hpp"

namespace brainshift {

Tissue::Tissue(const Mesh& mesh, const std::vector<std::pair<Index, Material>>& materials,
               VolumeStrain volume_strain)
    : m_mesh(mesh) {
  if (volume_strain == VolumeStrain::nodal && mesh.is_quadratic()) {
    throw Error(ErrorCode::invalid_argument,
                "nodal volume strain is for linear tets, not quadratic");
  }
  for (const auto& [region, material] : materials) {
    for (const auto& other : materials) {
      if (&other.second != &material && other.first == region) {
        throw Error(ErrorCode::invalid_argument,
                    "region " + std::to_string(region) + " is given two materials");
      }
    }
    m_parts.push_back({material, {}});
    m_stiffest = std::max(m_stiffest, material.young());
    m_softest = std::min(m_softest, material.young());
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
    const auto part = std::size_t(found - materials.begin());
    m_parts[part].tets.push_back(t);
    m_part_of[region] = part;
  }
  make_elements();
  if (volume_strain == VolumeStrain::nodal) average_volumes();
}

const Material& Tissue::material_of(Index t) const {
  return m_parts[m_part_of.at(m_mesh.regions()[std::size_t(t)])].material;
}

void Tissue::make_elements() {
  m_connectivity.resize(m_mesh.tet_count(), nodes_per_tet());
  m_connectivity.leftCols<4>() = m_mesh.tets();
  if (m_mesh.is_quadratic()) {
    m_connectivity.rightCols<6>() = m_mesh.edge_nodes();
  }
  const auto elements = std::make_shared<Elements>();
  if (m_mesh.is_quadratic()) elements->emplace<std::vector<Tet10>>();
  std::visit(
      [&](auto& list) {
        list.reserve(std::size_t(m_mesh.tet_count()));
        for (Index t = 0; t < m_mesh.tet_count(); ++t) list.emplace_back(m_mesh, t);
      },
      *elements);
  m_elements = elements;
}

namespace {

bool same_law(const Material& a, const Material& b) {
  return a.law() == b.law() && a.young() == b.young() && a.poisson() == b.poisson();
}

}  // namespace

// Regions of the same law and stiffness share their averages.
void Tissue::average_volumes() {
  std::vector<Indices> tets_of;
  std::vector<double> lambda;
  for (std::size_t p = 0; p < m_parts.size(); ++p) {
    bool known = false;
    for (std::size_t q = 0; q < p; ++q) known |= same_law(m_parts[p].material, m_parts[q].material);
    if (known || m_parts[p].material.lambda() <= 0.0) continue;  // negative: nothing locks
    tets_of.emplace_back();
    lambda.push_back(m_parts[p].material.lambda());
    for (const Part& part : m_parts) {
      if (!same_law(part.material, m_parts[p].material)) continue;
      tets_of.back().insert(tets_of.back().end(), part.tets.begin(), part.tets.end());
    }
    std::sort(tets_of.back().begin(), tets_of.back().end());
  }
  m_volume = NodalVolume(m_mesh, std::get<std::vector<Tet4>>(*m_elements), tets_of, lambda);
}

Lame Tissue::element_constants(const Part& part) const {
  Lame lame = lame_of(part.material);
  if (!m_volume.empty()) lame.lambda = std::min(lame.lambda, 0.0);
  return lame;
}

// Measures of the change of volume, and where `gradients` is given their gradients by F.
std::vector<double> Tissue::volume_measures(const Points& u, std::vector<Mat3>* gradients) const {
  const auto& elements = std::get<std::vector<Tet4>>(*m_elements);
  std::vector<double> theta(elements.size());
  if (gradients) gradients->resize(elements.size());
  for_all_tets([&](const LawFunctions& law, const Lame&, Index t) {
    const VolumeMeasure m =
        law.volume(elements[std::size_t(t)].displacement_gradient(u, nodes_of(t), 0));
    theta[std::size_t(t)] = m.value;
    if (gradients) (*gradients)[std::size_t(t)] = m.gradient;
  });
  return theta;
}

namespace {

constexpr double no_jacobian = std::numeric_limits<double>::infinity();

// What is no number is smaller than any.
void take_smaller(double J, double& least) {
  if (!std::isnan(least) && !(J >= least)) least = J;
}

// In the order of the tets, whatever the threads.
double sum_of(const std::vector<double>& energies) {
  double sum = 0.0;
  for (double energy : energies) sum += energy;
  return sum;
}

}  // namespace

double Tissue::energy(const Points& u) const {
  std::vector<double> energies(std::size_t(m_mesh.tet_count()), 0.0);
  std::visit(
      [&](const auto& elements) {
        for_all_tets([&](const LawFunctions& law, const Lame& lame, Index t) {
          const auto& e = elements[std::size_t(t)];
          for (int q = 0; q < e.points; ++q) {
            energies[std::size_t(t)] +=
                e.volumes[q] * law.energy(lame, e.displacement_gradient(u, nodes_of(t), q));
          }
        });
      },
      *m_elements);
  const double sum = sum_of(energies);
  return m_volume.empty() ? sum : sum + m_volume.energy(volume_measures(u));
}

TissueResponse Tissue::response(const Points& u) const {
  return std::visit([&](const auto& elements) { return response(elements, u); }, *m_elements);
}

template <class Element>
TissueResponse Tissue::response(const std::vector<Element>& elements, const Points& u) const {
  TissueResponse all;
  std::vector<Mat3> gradients;
  std::vector<double> measures, pressures;
  if (!m_volume.empty()) {
    measures = volume_measures(u, &gradients);
    pressures = m_volume.pressures(measures);
  }
  std::vector<typename Element::Rows> forces(elements.size(), Element::Rows::Zero());
  std::vector<double> energies(elements.size(), 0.0);
  all.jacobians = Eigen::VectorXd::Constant(Eigen::Index(elements.size()), no_jacobian);
  for_all_tets([&](const LawFunctions& law, const Lame& lame, Index t) {
    const Element& e = elements[std::size_t(t)];
    for (int q = 0; q < Element::points; ++q) {
      const Mat3 G = e.displacement_gradient(u, nodes_of(t), q);
      Mat3 P;
      energies[std::size_t(t)] += e.volumes[q] * law.energy_and_stress(lame, G, P);
      if (!pressures.empty()) P += pressures[std::size_t(t)] * gradients[std::size_t(t)];
      forces[std::size_t(t)] += e.volumes[q] * e.gradients[q] * P.transpose();
      take_smaller(1.0 + volume_change(G), all.jacobians[t]);
    }
  });
  scatter(forces, all.force);
  all.energy = sum_of(energies);
  if (!m_volume.empty()) all.energy += m_volume.energy(measures);
  return all;
}

Points Tissue::gravity_force(const Vec3& gravity) const {
  Points force = Points::Zero(m_mesh.node_count(), 3);
  for (const Part& part : m_parts) {
    for (Index t : part.tets) {
      const Eigen::VectorXd shares =
          m_mesh.is_quadratic() ? quadratic_volumes(t) : linear_volumes(t);
      for (int a = 0; a < nodes_per_tet(); ++a) {
        force.row(nodes_of(t)[a]) += part.material.density() * shares[a] * gravity.transpose();
      }
    }
  }
  return force;
}

// int N_a over a tet, mm^3.
Eigen::VectorXd Tissue::linear_volumes(Index t) const {
  return Eigen::VectorXd::Constant(4, 0.25 * volume_of(t));
}

Eigen::VectorXd Tissue::quadratic_volumes(Index t) const {
  const auto x = ten_rows(m_mesh.nodes(), m_mesh.tets(), m_mesh.edge_nodes(), t);
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(10);
  for (const TetQuadraturePoint& point : tet_rule_5()) {
    const double weight = point.weight * quadratic_jacobian(x, point.L).determinant() / 6.0;
    volumes += weight * quadratic_shape(point.L);
  }
  return volumes;
}

double Tissue::volume_of(Index t) const {
  return std::visit([t](const auto& elements) { return elements[std::size_t(t)].volume(); },
                    *m_elements);
}

double Tissue::mass() const {
  double sum = 0.0;
  for (const Part& part : m_parts) {
    for (Index t : part.tets) sum += part.material.density() * volume_of(t);
  }
  return sum;
}

Eigen::VectorXd Tissue::node_masses() const {
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(m_mesh.node_count());
  const double corner = m_mesh.is_quadratic() ? 1.0 / 36.0 : 0.25, edge = 4.0 / 27.0;
  for (const Part& part : m_parts) {
    for (Index t : part.tets) {
      const double mass = part.material.density() * volume_of(t);
      for (int a = 0; a < nodes_per_tet(); ++a) {
        masses[nodes_of(t)[a]] += mass * (a < 4 ? corner : edge);
      }
    }
  }
  return masses;
}

Eigen::VectorXd Tissue::jacobians(const Points& u) const {
  Eigen::VectorXd result(m_mesh.tet_count());
  std::visit(
      [&](const auto& elements) {
        for_all_tets([&](const LawFunctions&, const Lame&, Index t) {
          const auto& e = elements[std::size_t(t)];
          result[t] = no_jacobian;
          for (int q = 0; q < e.points; ++q) {
            take_smaller(1.0 + volume_change(e.displacement_gradient(u, nodes_of(t), q)), result[t]);
          }
        });
      },
      *m_elements);
  return result;
}

std::vector<Indices> Tissue::node_adjacency() const {
  std::vector<Indices> near(std::size_t(m_mesh.node_count()));
  for (Index t = 0; t < m_mesh.tet_count(); ++t) {
    for (int a = 0; a < nodes_per_tet(); ++a) {
      for (int b = 0; b < nodes_per_tet(); ++b) {
        if (a != b) near[std::size_t(nodes_of(t)[a])].push_back(nodes_of(t)[b]);
      }
    }
  }
  m_volume.extend(near);
  for (Indices& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return near;
}

}  // namespace brainshift
