#include "measure.hpp"

#include <cmath>
#include <limits>

namespace dbs {
namespace {

Index compartment_of(const Stepper& stepper, int side) {
  return stepper.csf().find(name_of(side));
}

double tissue_volume(const Stepper& stepper) {
  double sum = 0.0;
  for (int side : {left, right}) sum += stepper.compartment(compartment_of(stepper, side)).tissue_volume;
  return sum;
}

}  // namespace

TissueMeasures::TissueMeasures(const Head& head, const Stepper& stepper)
    : m_head(head),
      m_before(Points::Zero(stepper.mesh().node_count(), 3)),
      m_volume_before(tissue_volume(stepper)) {
  std::vector<char> medial(std::size_t(head.brain.node_count()), 0);
  for (std::size_t i = 0; i < medial.size(); ++i) medial[i] = head.pair[i] >= 0;
  for (int side : {left, right}) {
    std::vector<char> seen(medial);
    for (Index f : head.brain.faces_of_region(Head::region(side))) {
      for (int k = 0; k < 3; ++k) {
        const Index node = head.brain.surface()(f, k);
        if (!seen[std::size_t(node)]) m_outer[side].push_back(node);
        seen[std::size_t(node)] = 1;
      }
    }
  }
  prepare_landmarks();
  m_landmarks_before = Points::Zero(m_landmarks.rows(), 3);
}

void TissueMeasures::prepare_landmarks() {
  m_landmarks.resize(Eigen::Index(m_head.landmarks.size()), 3);
  for (const auto& [name, point] : m_head.landmarks) {
    m_landmarks.row(Eigen::Index(m_names.size())) = point.transpose();
    m_names.push_back(name);
  }
  const Location where = m_head.brain.locate(m_landmarks);
  for (Eigen::Index i = 0; i < m_landmarks.rows(); ++i) {
    if (where.tet[std::size_t(i)] >= 0) continue;   // else: the tissue closest to it
    Eigen::Index nearest;
    (m_head.brain.nodes().rowwise() - m_landmarks.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
    m_landmarks.row(i) = m_head.brain.nodes().row(nearest);
  }
}

void TissueMeasures::set_reference(const Stepper& stepper) {
  m_before = stepper.displacement();
  m_landmarks_before = stepper.displacement_at(m_landmarks).values;
  m_volume_before = tissue_volume(stepper);
}

void TissueMeasures::fill(const Stepper& stepper, StageResult& result) const {
  const Points u = stepper.displacement() - m_before;   // edge nodes follow the head's own
  for (int side : {left, right}) {
    result.fluid[side] = stepper.compartment(compartment_of(stepper, side));
    result.surface_motion[side] = 0.0;
    for (Index node : m_outer[side]) {
      result.surface_motion[side] = std::max(result.surface_motion[side], u.row(node).norm());
    }
  }
  result.tissue_loss = m_volume_before - tissue_volume(stepper);
  result.midline_shift = 0.0;
  for (Index node : m_head.falx) {
    result.midline_shift += u(node, 0) / double(m_head.falx.size());
  }
  const Points now = stepper.displacement_at(m_landmarks).values;
  for (std::size_t i = 0; i < m_names.size(); ++i) {
    const auto row = Eigen::Index(i);
    result.shifts[m_names[i]] = (now.row(row) - m_landmarks_before.row(row)).transpose();
  }
}

void TissueMeasures::estimate_errors(const Stepper& stepper, StageResult& result) const {
  const ErrorEstimate estimate = stepper.estimate_error(m_landmarks);
  for (std::size_t i = 0; i < m_names.size(); ++i) {
    result.errors[m_names[i]] = estimate.error[Eigen::Index(i)];
  }
}

TipMark::TipMark(const Stepper& stepper, const Vec3& tip)
    : m_tip(tip), m_rest(stepper.rest_points_of(tip.transpose())) {}

Retraction TipMark::since(const Stepper& stepper, const Vec3& tip, const Vec3& outward) const {
  const double skull = (tip - m_tip).dot(outward);
  if (m_rest.tet.front() < 0) return {skull, std::numeric_limits<double>::quiet_NaN()};
  const Vec3 now =
      (m_rest.values + stepper.displacement_at(m_rest.values).values).row(0).transpose();
  return {skull, skull - (now - m_tip).dot(outward)};
}

}  // namespace dbs
