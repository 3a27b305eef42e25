#include "stepper/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>

#include "brainshift/error.hpp"

namespace brainshift {

Equilibrium::Equilibrium(const Scene& scene)
    : m_tissue(scene.mesh, scene.materials, scene.volume_strain),
      m_adjacency(m_tissue.node_adjacency()),
      m_balanced(scene.balanced_reference),
      m_reference_gravity(scene.gravity) {
  if (!scene.gravity.allFinite()) {
    throw Error(ErrorCode::not_finite, "Scene: gravity is not finite");
  }
  if (mesh().is_quadratic()) {
    for (Index i = 0; i < mesh().node_count(); ++i) m_silent.push_back(mesh().is_corner(i));
  }
  if (scene.csf) m_fluid.emplace(scene.mesh, *scene.csf, scene.gravity);
  // Forces of a millionth of E L^2 are far below any load that moves the body visibly.
  const double area = mesh().diameter() * mesh().diameter();
  m_force_floor = 1e-6 * m_tissue.stiffest() * area;
  m_softest_floor = 1e-6 * m_tissue.softest() * area;
  configure(scene.constraints, scene.csf, scene.gravity);
}

namespace {

// Whether ties or pairs differ, which shape the pattern of the matrix.
bool same_pattern(const ConstraintSet& a, const ConstraintSet& b) {
  const auto shaping = [](const ConstraintSet& set) {
    std::vector<ConstraintId> ids;
    for (const ConstraintGroup& g : set.groups()) {
      const bool shapes = g.kind == ConstraintKind::tied || g.kind == ConstraintKind::opposing;
      if (g.enabled && shapes) ids.push_back(g.id);
    }
    return ids;
  };
  return shaping(a) == shaping(b);
}

}  // namespace

void Equilibrium::configure(const ConstraintSet& constraints, const std::optional<Csf>& csf,
                            const Vec3& gravity) {
  Equilibrium next = *this;
  if (next.m_fluid) next.m_fluid->configure(*csf, gravity);
  const Vec3 effective = m_balanced ? Vec3(gravity - m_reference_gravity) : gravity;
  next.m_gravity_force = m_tissue.gravity_force(effective);
  if (!m_blocks || !same_pattern(m_constraints, constraints)) {
    next.m_blocks = std::make_shared<Blocks>(mesh(), m_adjacency, constraints);
    next.m_map = std::make_shared<ElementMap>(
        m_tissue.map_elements(next.m_blocks->block_of(), next.m_blocks->make_matrix()));
  }
  const Indices& block_of = next.m_blocks->block_of();
  check_nodes(constraints, mesh().node_count());
  next.m_constraints = constraints;
  next.m_contacts = ContactRows(constraints, block_of, mesh().nodes(), m_silent);
  next.m_fixed.clear();
  next.m_springs.setZero(mesh().node_count());
  for (const ConstraintGroup& group : constraints.groups()) {
    if (!group.enabled) continue;
    for (std::size_t i = 0; i < group.nodes.size(); ++i) {
      const Index node = group.nodes[i];
      if (group.kind == ConstraintKind::support) {
        next.m_springs[node] += group.stiffness[Eigen::Index(i)];
      }
      for (int axis = 0; axis < 3 && group.kind == ConstraintKind::fixed; ++axis) {
        if (group.axes[std::size_t(axis)]) {
          next.m_fixed.push_back({block_of[std::size_t(node)], -1, Vec3::Unit(axis), 0.0,
                                  std::size_t(node)});
        }
      }
    }
  }
  *this = std::move(next);
}

// Each body (connected through elements and ties) must have its six rigid motions held by fixed
// nodes, springs or contact; otherwise a quasi-static solve has no answer, or any.
void Equilibrium::check_supported() const {
  const Indices& block_of = m_blocks->block_of();
  const Index bodies = mesh().component_count();
  Indices body(std::size_t(bodies), 0);
  for (Index b = 0; b < bodies; ++b) body[std::size_t(b)] = b;
  std::vector<Index> body_of_block(std::size_t(m_blocks->count()), -1);
  const auto root = [&body](Index b) {
    while (body[std::size_t(b)] != b) b = body[std::size_t(b)];
    return b;
  };
  for (Index i = 0; i < mesh().node_count(); ++i) {
    const Index mine = root(mesh().components()[std::size_t(i)]);
    Index& seen = body_of_block[std::size_t(block_of[std::size_t(i)])];
    if (seen < 0) seen = mine;
    const Index other = root(seen);
    body[std::size_t(std::max(mine, other))] = std::min(mine, other);
  }
  std::vector<Eigen::Matrix<double, 6, 6>> held(std::size_t(bodies),
                                                Eigen::Matrix<double, 6, 6>::Zero());
  std::vector<bool> touched(std::size_t(bodies), false);
  const Vec3 centre = mesh().nodes().colwise().mean().transpose();
  const auto hold = [&](Index node, const Vec3& direction) {
    const Vec3 arm = (mesh().nodes().row(node).transpose() - centre) / mesh().diameter();
    Eigen::Matrix<double, 6, 1> row;
    row << direction, arm.cross(direction);
    held[std::size_t(root(mesh().components()[std::size_t(node)]))] += row * row.transpose();
  };
  for (const NodeRow& row : m_fixed) hold(Index(row.tag), row.normal);
  for (Index i = 0; i < mesh().node_count(); ++i) {
    for (int axis = 0; axis < 3 && m_springs[i] > 0.0; ++axis) hold(i, Vec3::Unit(axis));
  }
  for (std::size_t r = 0; r < m_contacts.size(); ++r) {
    touched[std::size_t(root(mesh().components()[std::size_t(m_contacts.mesh_node(r))]))] = true;
    if (m_contacts.row(r).partner < 0) continue;
    const Index partner = m_contacts.group_of(r).partners[m_contacts.row(r).item];
    touched[std::size_t(root(mesh().components()[std::size_t(partner)]))] = true;
  }
  for (Index b = 0; b < bodies; ++b) {
    if (root(b) != b || touched[std::size_t(b)]) continue;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> modes(held[std::size_t(b)]);
    const auto loose = (modes.eigenvalues().array() <= 1e-10).count();
    if (loose == 0) continue;
    throw Error(ErrorCode::rigid_mode,
                "body " + std::to_string(b) + " of the mesh has " + std::to_string(loose) +
                    " rigid motions that no fixed node, support or contact holds");
  }
}

Points Equilibrium::external_force(const Points& u, std::vector<double>* heads) const {
  Points force = m_gravity_force;
  if (m_fluid) {
    const Points x = positions(u);
    std::vector<double> h = m_fluid->heads(x);
    m_fluid->add_force(x, h, 1.0, force);
    if (m_balanced) m_fluid->add_reference_force(x, -1.0, force);
    if (heads) *heads = std::move(h);
  }
  return force;
}

Forces Equilibrium::forces(const Points& u) const {
  Forces f;
  TissueResponse tissue = m_tissue.response(u);
  f.internal = std::move(tissue.force);
  f.internal.array() += u.array().colwise() * m_springs.array();
  f.stored = tissue.energy + 0.5 * m_springs.dot(u.rowwise().squaredNorm());
  f.jacobians = std::move(tissue.jacobians);
  f.external = external_force(u, &f.heads);
  m_contacts.sample(u, f.gaps);
  return f;
}

double Equilibrium::external_work(const Points& u0, const Points& external0, const Points& u1,
                                  const Points& external1) const {
  const Points step = u1 - u0;
  if (!m_fluid) return external0.cwiseProduct(step).sum();
  const Points middle = external_force(0.5 * (u0 + u1));
  return ((external0 + 4.0 * middle + external1) / 6.0).cwiseProduct(step).sum();
}

void Equilibrium::stored_tangent(const Points& u, bool definite, BlockMatrix& K) const {
  K.set_zero();
  m_tissue.tangent(u, definite, *m_map, K);
  const Indices& block_of = m_blocks->block_of();
  for (Index i = 0; i < mesh().node_count(); ++i) {
    if (m_springs[i] > 0.0) {
      K.add(K.slot_at(block_of[std::size_t(i)], 0), m_springs[i] * Mat3::Identity());
    }
  }
}

void Equilibrium::tangent(const Points& u, const Forces& f, const std::vector<double>& multipliers,
                          bool definite, BlockMatrix& K) const {
  stored_tangent(u, definite, K);
  const Indices& block_of = m_blocks->block_of();
  if (m_fluid) {
    const Points x = positions(u);
    m_fluid->add_tangent(x, f.heads, block_of, K);
    if (m_balanced) m_fluid->add_reference_tangent(x, -1.0, block_of, K);
  }
  for (std::size_t r = 0; r < m_contacts.size(); ++r) {
    if (multipliers[r] <= 0.0 || m_contacts.row(r).partner >= 0) continue;
    const Mat3 curvature = -multipliers[r] * m_contacts.hessian(r, u);
    K.add(K.slot_at(m_contacts.row(r).node, 0), curvature);
  }
}

std::vector<RankOne> Equilibrium::head_terms(const Points& u, const Forces& f) const {
  if (!m_fluid) return {};
  return m_fluid->head_terms(positions(u), f.heads);
}

Eigen::VectorXd Equilibrium::contact_force(const Forces& f,
                                           const std::vector<double>& multipliers) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * m_blocks->count());
  for (std::size_t r = 0; r < m_contacts.size(); ++r) {
    if (multipliers[r] == 0.0) continue;
    const ContactRow& row = m_contacts.row(r);
    force.segment<3>(3 * row.node) += multipliers[r] * f.gaps[r].normal;
    if (row.partner >= 0) {
      force.segment<3>(3 * row.partner) -= multipliers[r] * f.gaps[r].normal;
    }
  }
  return force;
}

}  // namespace brainshift
