// Volumes below a plane, and the head at which a group of compartments is in balance.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/faces.hpp"
#include "fluid/hydrostatics.hpp"
#include "fluid/quadratic_face.hpp"

namespace brainshift {
namespace {

// Adds what an outward face of a closed body contributes to its volume below the plane and to its
// section by the plane (divergence theorem with the field (height - head) * up, zero on the plane).
void add_below(const Face& face, const Vec3& up, double head, double& volume, double& section) {
  if (face.heights.minCoeff() >= head) return;
  const WetMoments m = wet_moments(face.heights, head, true);
  const double a = face.area.dot(up);
  volume -= a * m.depth(face.heights, head).sum();
  section -= a * m.L.sum();
}

}  // namespace

Hydrostatics::Body Hydrostatics::wall_below(std::size_t c, double head) const {
  const Compartment& compartment = m_compartments[c];
  Body body;
  for (Index f = 0; f < compartment.wall_triangles.rows(); ++f) {
    const Face face(compartment.wall_points, compartment.wall_triangles, f, m_up);
    add_below(face, m_up, head, body.volume, body.section);
  }
  return body;
}

Hydrostatics::Body Hydrostatics::tissue_below(std::size_t c, const Points& x, double head) const {
  Body body;
  for (Index f : m_body_parts[c]) {
    add_below(Face(x, m_parts, f, m_up), m_up, head, body.volume, body.section);
  }
  return body;
}

double Hydrostatics::tissue_volume(std::size_t c, const Points& x) const {
  const Indices& parts = m_body_parts[c];
  if (parts.empty()) return 0.0;
  const Vec3 origin = x.row(m_parts(parts.front(), 0)).transpose();
  double sum = 0.0;
  for (Index f : parts) {
    const Face face(x, m_parts, f, m_up);
    sum += (face.x[0] - origin).dot(face.area) / 6.0;
  }
  return sum;
}

std::vector<double> Hydrostatics::tissue_totals(const Points& x) const {
  std::vector<double> totals;
  for (std::size_t c = 0; c < m_compartments.size(); ++c) totals.push_back(tissue_volume(c, x));
  return totals;
}

// value(head) = 0 is the group's law. lost_volume: fluid there is minus fluid there should be.
// air_volume: air there should be minus air there is. Both rise with the head.
Hydrostatics::Balance Hydrostatics::balance(const Group& group, const Points& x,
                                            const std::vector<double>& tissue_total,
                                            double head) const {
  Balance b{group.amount, 0.0};
  for (std::size_t c : group.members) {
    if (!m_open[c]) {
      if (group.law == FluidLaw::lost_volume) b.value += m_rest_tissue[c] - tissue_total[c];
      continue;
    }
    const Body wall = wall_below(c, head), tissue = tissue_below(c, x, head);
    b.value += wall.volume - tissue.volume - m_wall_volume[c];
    b.value += group.law == FluidLaw::lost_volume ? m_rest_tissue[c] : tissue_total[c];
    b.slope += wall.section - tissue.section;
  }
  // Above the cavity the fluid stands in a narrow chimney (the burr hole): without it a tissue that
  // swells past the fluid lost, as an iterate may, would have no head at all.
  if (head > m_full_head) {
    b.value += m_chimney * (head - m_full_head);
    b.slope += m_chimney;
  }
  return b;
}

// Newton kept inside a bracket; the balance is monotone in the head.
double Hydrostatics::solve_head(const Group& group, const Points& x,
                                const std::vector<double>& tissue_total) const {
  double low = std::numeric_limits<double>::infinity();
  for (std::size_t c : group.members)
    low = std::min(low, (m_compartments[c].wall_points * m_up).minCoeff());
  double high = m_full_head, volume = 0.0;
  for (std::size_t c : group.members) volume += m_wall_volume[c];
  if (balance(group, x, tissue_total, high).value < 0.0) {
    low = high;
    high += volume / m_chimney;
  }
  double head =
      group.law == FluidLaw::lost_volume || low == m_full_head ? high : 0.5 * (low + high);
  for (int i = 0; i < 200; ++i) {
    const Balance b = balance(group, x, tissue_total, head);
    if (std::abs(b.value) <= 1e-15 * volume) break;
    (b.value > 0.0 ? high : low) = head;
    double next = b.slope > 0.0 ? head - b.value / b.slope : low;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == head || high - low <= 1e-15 * (std::abs(high) + std::abs(low))) break;
    head = next;
  }
  return head;
}

std::vector<double> Hydrostatics::heads(const Points& x) const {
  std::vector<double> result(m_compartments.size(), m_full_head);
  std::vector<double> totals;
  for (const Group& group : m_groups) {
    double head = m_full_head;
    if (group.law == FluidLaw::level) {
      head = group.amount;
    } else if (group.law != FluidLaw::full) {
      if (totals.empty()) totals = tissue_totals(x);
      head = solve_head(group, x, totals);
    }
    for (std::size_t c : group.members) result[c] = head;
  }
  return result;
}

void Hydrostatics::add_volume_gradient(const Points& x, const Indices& parts, double head,
                                       bool clip, double factor, Points& gradient) const {
  for (Index f : parts) {
    const Face face(x, m_parts, f, m_up);
    const WetMoments m = wet_moments(face.heights, head, clip);
    if (m.dry()) continue;
    for (int i = 0; i < 3; ++i) {
      gradient.row(face.nodes[i]) += (factor * m.L[i] * face.area).transpose();
    }
  }
}

void Hydrostatics::add_head_slope(const Points& x, const Indices& faces, double head, bool clip,
                                  double w, Points& slope) const {
  if (!m_mesh.is_quadratic()) return add_volume_gradient(x, faces, head, clip, -w, slope);
  for (Index f : faces) {
    const QuadraticFace face(x, m_mesh, f, m_up);
    const QuadraticFace::Load load = face.load(head, clip);
    if (load.dry) continue;
    for (std::size_t i = 0; i < 6; ++i) slope.row(face.nodes()[i]) -= w * load.area[i].transpose();
  }
}

// With value(head, x) = 0: dh/dx = -value_x / slope, and the force depends on the head as
// df/dh = -w sum a L. Hence K gains -df/dh (dh/dx)^T = (df/dh) value_x^T / slope.
std::vector<RankOne> Hydrostatics::head_terms(const Points& x,
                                              const std::vector<double>& heads) const {
  std::vector<RankOne> terms;
  for (const Group& group : m_groups) {
    if (group.law == FluidLaw::full || group.law == FluidLaw::level) continue;
    RankOne term{Points::Zero(x.rows(), 3), Points::Zero(x.rows(), 3)};
    const double head = heads[group.members.front()];
    double slope = head > m_full_head ? m_chimney : 0.0;
    for (std::size_t c : group.members) {
      const Compartment& compartment = m_compartments[c];
      add_head_slope(x, compartment.wetted_faces, head, clips(c), weight_per_volume(), term.column);
      if (m_open[c]) {
        slope += wall_below(c, head).section - tissue_below(c, x, head).section;
        add_volume_gradient(x, m_body_parts[c], head, true, -1.0, term.row);
      }
      const bool total = m_open[c] == (group.law == FluidLaw::air_volume);
      if (total) {
        const double sign = m_open[c] ? 1.0 : -1.0;
        add_volume_gradient(x, m_body_parts[c], head, false, sign, term.row);
      }
    }
    // Near the top of the cavity the section vanishes; the chimney's keeps the term finite.
    term.row /= std::max(slope, 0.01 * m_chimney);
    terms.push_back(std::move(term));
  }
  return terms;
}

CompartmentState Hydrostatics::state(Index compartment, const Points& x,
                                     const std::vector<double>& heads) const {
  const auto c = std::size_t(compartment);
  CompartmentState s{};
  s.open = m_open[c];
  s.head = heads[c];
  s.tissue_volume = tissue_volume(c, x);
  const double space = m_wall_volume[c] - s.tissue_volume;
  if (s.open) {
    const double below = wall_below(c, s.head).volume - tissue_below(c, x, s.head).volume;
    s.air_volume = space - below;
  }
  s.fluid_volume = space - s.air_volume;
  s.lost_volume = m_wall_volume[c] - m_rest_tissue[c] - s.fluid_volume;
  return s;
}

}  // namespace brainshift
