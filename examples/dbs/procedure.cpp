#include "procedure.hpp"

#include <cstdio>
#include <unistd.h>

namespace dbs {

Stepper Procedure::make_stepper(const Head& head, const Options& options, SceneIds& ids) {
  StepperOptions stepper;
  if (!options.quiet && isatty(2)) {
    stepper.progress = [](const Progress& p) {
      std::fprintf(stderr, "\r  iteration %2d, residual %.1e, load %.3f ", p.iteration, p.residual,
                   p.load_factor);
      return true;
    };
  }
  return Stepper(make_scene(head, options, ids), stepper);
}

Procedure::Procedure(const Head& head, const Options& options)
    : m_head(head),
      m_options(options),
      m_loss{parse_loss(options.left), parse_loss(options.right)},
      m_gravity(gravity_of(options.elevation)),
      m_stepper(make_stepper(head, options, m_ids)),
      m_full_level(full_level(head, m_gravity)),
      m_volume_before(head.brain.volume()),
      m_before(Points::Zero(head.brain.node_count(), 3)),
      m_facing_falx(head.falx) {
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
  check_plan();
}

void Procedure::prepare_landmarks() {
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

void Procedure::check_plan() {
  const auto before = m_stepper.snapshot();
  for (const auto& stage : plan()) {
    set_fluid(stage.first);
    m_stepper.check_settings();
  }
  m_stepper.restore(before);
}

std::vector<std::pair<int, std::string>> Procedure::plan() const {
  std::vector<std::pair<int, std::string>> stages{{0, "before surgery"}};
  const bool both = m_loss[left].amount > 0.0;
  if (m_loss[right].amount > 0.0) {
    stages.emplace_back(1, "right craniotomy");
    if (m_options.late > 0.0) stages.emplace_back(4, "right, testing");
  }
  if (both) {
    stages.emplace_back(6, "left craniotomy");
    if (m_options.late > 0.0) stages.emplace_back(7, "left, testing");
  }
  stages.emplace_back(9, "CSF restored");
  return stages;
}

// Sets the fluid of a side to `part` of its loss. A communicating fluid is one: it has lost what
// both sides lost, and its level is the lower of the two asked for.
void Procedure::lose(int side, const Loss& loss, double part) {
  Csf& csf = m_stepper.csf();
  const bool one_fluid = csf.model() == FluidModel::communicating;
  double amount = part * loss.amount;
  const Index other = csf.find(name_of(1 - side));
  if (one_fluid && csf.is_open(other) && loss.law == m_loss[1 - side].law) {
    const double others = m_loss[1 - side].amount;
    amount = loss.law == FluidLaw::level ? std::max(amount, others) : amount + others;
  }
  const Index mine = csf.find(name_of(side));
  if (loss.law == FluidLaw::level) csf.set_level(mine, m_full_level - amount);
  if (loss.law == FluidLaw::lost_volume) csf.set_lost_volume(mine, amount);
  if (loss.law == FluidLaw::air_volume) csf.set_air_volume(mine, amount);
}

void Procedure::set_fluid(int number) {
  const double early = 1.0 - m_options.late;
  switch (number) {
    case 1: return lose(right, m_loss[right], early);
    case 4: return lose(right, m_loss[right], 1.0);
    case 6: return lose(left, m_loss[left], early);
    case 7: return lose(left, m_loss[left], 1.0);
    case 9:
      m_stepper.csf().set_full(m_stepper.csf().find(name_of(left)));
      m_stepper.csf().set_full(m_stepper.csf().find(name_of(right)));
      return;
    default: return;
  }
}

StageResult Procedure::run(int number, const std::string& title) {
  StageResult result{};
  result.number = number;
  result.title = title;
  set_fluid(number);
  result.report = m_stepper.solve_static();
  if (!m_options.quiet && isatty(2)) std::fprintf(stderr, "\r%60s\r", "");
  if (number == 0) {
    m_before = m_stepper.displacement();
    m_volume_before = 0.0;
    for (int side : {left, right}) {
      m_volume_before += m_stepper.compartment(m_stepper.csf().find(name_of(side))).tissue_volume;
    }
  }
  measure(result);
  return result;
}

void Procedure::measure(StageResult& result) const {
  const Points u = shift();
  double volume = 0.0;
  for (int side : {left, right}) {
    result.fluid[side] = m_stepper.compartment(m_stepper.csf().find(name_of(side)));
    volume += result.fluid[side].tissue_volume;
    for (Index node : m_outer[side]) {
      result.surface_motion[side] = std::max(result.surface_motion[side], u.row(node).norm());
    }
  }
  result.tissue_loss = m_volume_before - volume;
  for (Index node : m_facing_falx) result.midline_shift += u(node, 0) / double(m_facing_falx.size());
  const Location where = m_head.brain.locate(m_landmarks);
  for (std::size_t i = 0; i < m_names.size(); ++i) {
    Vec3& moved = result.shifts[m_names[i]] = Vec3::Zero();
    for (int a = 0; a < 4; ++a) {
      const Index node = m_head.brain.tets()(where.tet[i], a);
      moved += where.weights(Eigen::Index(i), a) * u.row(node).transpose();
    }
  }
}

}  // namespace dbs
