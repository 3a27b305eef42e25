#include "fluid/hydrostatics.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "brainshift/error.hpp"
#include "fluid/faces.hpp"
#include "fluid/quadratic_face.hpp"
#include "mesh/surface_topology.hpp"
#include "text.hpp"

namespace brainshift {
namespace {

void check_faces(const Indices& faces, Index count, const std::string& what) {
  for (Index f : faces) {
    if (f < 0 || f >= count) {
      throw Error(
          ErrorCode::index_out_of_range,
          what + " refers to surface face " + std::to_string(f) + " of " + std::to_string(count));
    }
  }
}

// A face wetted twice would carry its pressure twice.
void check_wetted_once(const Csf& csf, Index face_count) {
  Indices owner(std::size_t(face_count), -1);
  for (Index i = 0; i < csf.compartment_count(); ++i) {
    for (Index f : csf.compartment(i).wetted_faces) {
      Index& seen = owner[std::size_t(f)];
      if (seen >= 0) {
        throw Error(ErrorCode::invalid_argument,
                    "surface face " + std::to_string(f) + " is wetted twice, in compartment '" +
                        csf.compartment(seen).name + "' and in '" + csf.compartment(i).name + "'");
      }
      seen = i;
    }
  }
}

// To a thousandth.
std::string ml(double mm3) {
  return text(std::round(1e3 * mm3 / mm3_per_ml) / 1e3) + " mL";
}

}  // namespace

Hydrostatics::Hydrostatics(const Mesh& mesh, const Csf& csf, const Vec3& gravity)
    : m_mesh(mesh),
      m_density(csf.density()),
      m_model(csf.model()),
      m_gravity(gravity),
      m_up(-gravity.normalized()),
      m_reference_gravity(gravity),
      m_reference_up(m_up) {
  make_parts();
  for (Index i = 0; i < csf.compartment_count(); ++i) {
    const Compartment& c = csf.compartment(i);
    const Index face_count = Index(mesh.surface().rows());
    check_faces(c.body_faces, face_count, "the body of compartment '" + c.name + "'");
    check_faces(c.wetted_faces, face_count, "the wetted surface of compartment '" + c.name + "'");
    Triangles body(Eigen::Index(c.body_faces.size()), 3);
    for (std::size_t f = 0; f < c.body_faces.size(); ++f) {
      body.row(Eigen::Index(f)) = mesh.surface().row(c.body_faces[f]);
    }
    if (body.rows() > 0) {  // a compartment may hold fluid alone
      require_closed(mesh.nodes(), body, "the tissue in compartment '" + c.name + "'");
    }
    m_compartments.push_back(c);
    m_body_parts.push_back(parts_of(c.body_faces));
    m_rest_tissue.push_back(tissue_volume(std::size_t(i), mesh.nodes()));
    const Eigen::VectorXd x = c.wall_points * Vec3::UnitX();
    const double width = x.maxCoeff() - x.minCoeff();
    m_chimney = std::max(m_chimney, 0.01 * width * width);
  }
  check_wetted_once(csf, Index(mesh.surface().rows()));
  m_reference_head = head_axis_top(m_up);
  if (std::isfinite(csf.reference_head())) {
    if (csf.reference_head() < m_reference_head) {
      throw Error(ErrorCode::invalid_argument, "Csf: the reference head " +
                                                   text(csf.reference_head()) +
                                                   " mm lies below the top of the cavity at " +
                                                   text(m_reference_head) + " mm");
    }
    m_reference_head = csf.reference_head();
  }
  configure(csf, gravity);
}

// The surface in flat triangles: its faces, or the four parts of each quadratic one.
void Hydrostatics::make_parts() {
  m_parts = m_mesh.surface();
  if (!m_mesh.is_quadratic()) return;
  m_parts.resize(4 * m_mesh.surface().rows(), 3);
  for (Eigen::Index f = 0; f < m_mesh.surface().rows(); ++f) {
    for (int p = 0; p < 4; ++p) {
      for (int k = 0; k < 3; ++k) {
        const int place = face_parts[p][k];
        m_parts(4 * f + p, k) =
            place < 3 ? m_mesh.surface()(f, place) : m_mesh.surface_edge_nodes()(f, place - 3);
      }
    }
  }
}

Indices Hydrostatics::parts_of(const Indices& faces) const {
  if (!m_mesh.is_quadratic()) return faces;
  Indices parts;
  for (Index f : faces) {
    for (Index p = 0; p < 4; ++p) parts.push_back(4 * f + p);
  }
  return parts;
}

double Hydrostatics::head_axis_top(const Vec3& up) const {
  double top = -std::numeric_limits<double>::infinity();
  for (const Compartment& c : m_compartments) {
    top = std::max(top, (c.wall_points * up).maxCoeff());
  }
  return top;
}

void Hydrostatics::take_gravity(const Csf& csf) {
  m_wall_volume.clear();
  for (std::size_t c = 0; c < m_compartments.size(); ++c) {
    const double top = (m_compartments[c].wall_points * m_up).maxCoeff();
    m_wall_volume.push_back(wall_below(c, top).volume);
    if (m_wall_volume.back() < m_rest_tissue[c]) {
      throw Error(ErrorCode::fluid_volume, "the tissue in compartment '" + m_compartments[c].name +
                                               "' fills " + ml(m_rest_tissue[c]) +
                                               ", its walls hold " + ml(m_wall_volume.back()));
    }
  }
  // Another posture keeps the pressure the full fluid has at the top of the cavity.
  const double margin = m_reference_head - head_axis_top(m_reference_up);
  m_full_head = head_axis_top(m_up) + (std::isfinite(csf.reference_head()) ? margin : 0.0);
  if (m_up == m_reference_up) m_full_head = m_reference_head;
}

void Hydrostatics::configure(const Csf& csf, const Vec3& gravity) {
  if (!gravity.allFinite() || gravity.norm() == 0.0) {
    throw Error(ErrorCode::invalid_argument, "a scene with CSF needs finite, non-zero gravity");
  }
  Hydrostatics next = *this;  // a bad setting leaves this object as it was
  next.m_gravity = gravity;
  next.m_up = -gravity.normalized();
  next.take_gravity(csf);
  next.m_open.clear();
  next.m_groups.clear();
  next.m_group_of.clear();
  for (Index i = 0; i < csf.compartment_count(); ++i) {
    const bool alone = m_model == FluidModel::separate || i == 0;
    if (alone) next.m_groups.emplace_back();
    next.m_groups.back().members.push_back(std::size_t(i));
    next.m_group_of.push_back(next.m_groups.size() - 1);
    next.m_open.push_back(csf.is_open(i));
    if (csf.is_open(i)) {
      next.m_groups.back().law = csf.law(i);
      next.m_groups.back().amount = csf.amount(i);
    }
  }
  for (const Group& group : next.m_groups) {
    // Fluid leaves, and air enters, where the group is open.
    std::string name;
    double free_space = 0.0;
    for (std::size_t c : group.members) {
      if (!next.m_open[c]) continue;
      name += (name.empty() ? "" : "' and '") + m_compartments[c].name;
      free_space += next.m_wall_volume[c] - m_rest_tissue[c];
    }
    const bool volume = group.law == FluidLaw::lost_volume || group.law == FluidLaw::air_volume;
    if (volume && std::abs(group.amount) > free_space) {
      throw Error(ErrorCode::fluid_volume, ml(group.amount) + " asked of compartment '" + name +
                                               "', which holds " + ml(free_space) + " of fluid");
    }
    const double top = next.m_full_head;
    if (group.law == FluidLaw::level && group.amount > top) {
      throw Error(ErrorCode::invalid_argument,
                  "the level " + text(group.amount) + " mm set for compartment '" + name +
                      "' lies above the full level " + text(top) + " mm");
    }
  }
  *this = std::move(next);
}

bool Hydrostatics::clips(std::size_t c) const {
  // Only in the communicating fluid can a compartment that air does not reach be under suction.
  const Group& group = m_groups[m_group_of[c]];
  return m_model == FluidModel::separate || group.law == FluidLaw::full || m_open[c];
}

void Hydrostatics::add_faces(const Points& x, const Indices& faces, const Vec3& up, double head,
                             bool clip, double w, Points& force) const {
  if (m_mesh.is_quadratic()) {
    for (Index f : faces) {
      const QuadraticFace face(x, m_mesh, f, up);
      const QuadraticFace::Load load = face.load(head, clip);
      if (load.dry) continue;
      for (std::size_t i = 0; i < 6; ++i) force.row(face.nodes()[i]) -= w * load.depth[i].transpose();
    }
    return;
  }
  for (Index f : faces) {
    const Face face(x, m_mesh.surface(), f, up);
    const WetMoments m = wet_moments(face.heights, head, clip);
    if (m.dry()) continue;
    const Vec3 depth = m.depth(face.heights, head);
    for (int i = 0; i < 3; ++i) force.row(face.nodes[i]) -= (w * depth[i] * face.area).transpose();
  }
}

void Hydrostatics::add_face_tangents(const Points& x, const Indices& faces, const Vec3& up,
                                     double head, bool clip, double w, const Indices& slot_of,
                                     BlockMatrix& K) const {
  if (m_mesh.is_quadratic()) {
    return add_quadratic_tangents(x, faces, up, head, clip, w, slot_of, K);
  }
  for (Index f : faces) {
    const Face face(x, m_mesh.surface(), f, up);
    const WetMoments m = wet_moments(face.heights, head, clip);
    if (m.dry()) continue;
    const Vec3 depth = m.depth(face.heights, head);
    Mat3 slope[3];
    for (int j = 0; j < 3; ++j) slope[j] = area_derivative(face.x[0], face.x[1], face.x[2], j);
    const Mat3 lift = face.area * up.transpose();
    const auto block = [&](int i, int j) -> Mat3 {  // -df_i/dx_j
      return w * (depth[i] * slope[j] - m.M(i, j) * lift);
    };
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Mat3 symmetric = 0.5 * (block(i, j) + block(j, i).transpose());
        K.add_at(slot_of[std::size_t(face.nodes[i])], slot_of[std::size_t(face.nodes[j])],
                 symmetric);
      }
    }
  }
}

void Hydrostatics::add_quadratic_tangents(const Points& x, const Indices& faces, const Vec3& up,
                                          double head, bool clip, double w, const Indices& slot_of,
                                          BlockMatrix& K) const {
  QuadraticFace::Slopes slopes;
  for (Index f : faces) {
    const QuadraticFace face(x, m_mesh, f, up);
    if (face.load(head, clip, slopes).dry) continue;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const Mat3 symmetric = 0.5 * w * (slopes[i][j] + slopes[j][i].transpose());
        K.add_at(slot_of[std::size_t(face.nodes()[i])], slot_of[std::size_t(face.nodes()[j])],
                 symmetric);
      }
    }
  }
}

void Hydrostatics::add_force(const Points& x, const std::vector<double>& heads, double factor,
                             Points& force) const {
  for (std::size_t c = 0; c < m_compartments.size(); ++c) {
    add_faces(x, m_compartments[c].wetted_faces, m_up, heads[c], clips(c),
              factor * weight_per_volume(), force);
  }
}

void Hydrostatics::add_reference_force(const Points& x, double factor, Points& force) const {
  const double w = m_density * m_reference_gravity.norm();
  for (const Compartment& c : m_compartments) {
    add_faces(x, c.wetted_faces, m_reference_up, m_reference_head, true, factor * w, force);
  }
}

void Hydrostatics::add_tangent(const Points& x, const std::vector<double>& heads,
                               const Indices& slot_of, BlockMatrix& K) const {
  for (std::size_t c = 0; c < m_compartments.size(); ++c) {
    add_face_tangents(x, m_compartments[c].wetted_faces, m_up, heads[c], clips(c),
                      weight_per_volume(), slot_of, K);
  }
}

void Hydrostatics::add_reference_tangent(const Points& x, double factor, const Indices& slot_of,
                                         BlockMatrix& K) const {
  const double w = m_density * m_reference_gravity.norm();
  for (const Compartment& c : m_compartments) {
    add_face_tangents(x, c.wetted_faces, m_reference_up, m_reference_head, true, factor * w,
                      slot_of, K);
  }
}

Eigen::VectorXd Hydrostatics::nodal_pressure(const Points& x,
                                             const std::vector<double>& heads) const {
  Eigen::VectorXd pressure = Eigen::VectorXd::Zero(x.rows());
  for (std::size_t c = 0; c < m_compartments.size(); ++c) {
    for (Index f : m_compartments[c].wetted_faces) {
      for (int k = 0; k < (m_mesh.is_quadratic() ? 6 : 3); ++k) {
        const Index node =
            k < 3 ? m_mesh.surface()(f, k) : m_mesh.surface_edge_nodes()(f, k - 3);
        const double depth = heads[c] - x.row(node).dot(m_up);
        pressure[node] = weight_per_volume() * (clips(c) ? std::max(depth, 0.0) : depth);
      }
    }
  }
  return pressure;
}

}  // namespace brainshift
