#include "procedure.hpp"

#include <cstdio>

namespace dbs {

Stepper Procedure::make_stepper(const Head& head, const Options& options, Watcher* watcher,
                                SceneIds& ids) {
  StepperOptions stepper = options.solver;
  stepper.threads = options.threads;
  if (options.accuracy > 0.0) stepper = within(options.accuracy, head.brain, std::move(stepper));
  if (watcher) stepper.progress = [watcher](const Progress& p) { return watcher->goes_on(p); };
  return Stepper(make_scene(head, options, ids), stepper);
}

Procedure::Procedure(const Head& head, const Options& options, Watcher* watcher)
    : m_head(head),
      m_options(options),
      m_watcher(watcher),
      m_loss{parse_loss(options.left), parse_loss(options.right)},
      m_gravity(gravity_of(options.elevation)),
      m_stepper(make_stepper(head, options, watcher, m_ids)),
      m_tissue(head, m_stepper),
      m_full_level(full_level(head, m_gravity)) {
  if (options.time_step > 0.0) m_stepper.set_damping({20.0, 0.0});   // 1/s: rest within a second
  plan_sides();
  check_losses();
  m_plan = make_plan();
  check_plan();
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
  if (loss.law == FluidLaw::lost_volume) {   // the library counts from the mesh as given
    amount += m_side[side].lost_before + (one_fluid ? m_side[1 - side].lost_before : 0.0);
  }
  const Index mine = csf.find(name_of(side));
  if (loss.law == FluidLaw::level) csf.set_level(mine, m_full_level - amount);
  if (loss.law == FluidLaw::lost_volume) csf.set_lost_volume(mine, amount);
  if (loss.law == FluidLaw::air_volume) csf.set_air_volume(mine, amount);
}

void Procedure::set_loads(const Stage& stage) {
  Csf& csf = m_stepper.csf();
  if (stage.action != Action::none) m_stepper.set_gravity(m_gravity);   // the posture of surgery
  if (stage.action == Action::lose_fluid) {
    lose(stage.side, m_loss[stage.side], 1.0 - m_options.late);
  } else if (stage.action == Action::test) {
    lose(stage.side, m_loss[stage.side], 1.0);
  } else if (stage.action == Action::restore) {
    for (int side : {left, right}) csf.set_full(csf.find(name_of(side)));
    m_stepper.set_gravity(gravity_of(imaging_elevation(m_options)));
  }
}

// Where the tissue of the target is now.
Vec3 Procedure::place_of_goal(int side) const {
  const Vec3& rest = m_side[side].goal_at_rest;
  return rest + m_stepper.displacement_at(rest.transpose()).values.row(0).transpose();
}

// Aimed at the planned point of the skull frame, or at where that point of the tissue has gone.
void Procedure::insert_cannula(int side) {
  Operated& o = m_side[side];
  if (m_options.aim == "tissue") {   // through the planned burr hole
    const Vec3 point = place_of_goal(side);
    const Vec3 outward = (o.trajectory->inner_table - point).normalized();
    o.trajectory = aim_at(m_head, m_options, side, point, outward);
    o.electrode.emplace(m_options, *o.trajectory);
  }
  const Electrode& e = *o.electrode;
  o.device = m_stepper.insert(e.cannula(), e.cannula_placement(), e.cannula_hold(), e.track());
  o.in_cannula = true;
}

void Procedure::insert_lead(int side) {
  Operated& o = m_side[side];
  const Electrode& e = *o.electrode;
  const std::string& first =
      m_options.test_electrode.empty() ? m_options.lead : m_options.test_electrode;
  m_stepper.exchange(o.device, e.lead_in_cannula(first), e.hold_in_cannula(), e.cannula_depth());
}

// The final lead takes over the track, and the burr hole its wire.
void Procedure::remove_cannula(int side) {
  Operated& o = m_side[side];
  if (m_options.test_electrode.empty() && !m_options.elastic_cannula) {
    m_stepper.set_hold(o.device, o.electrode->hold_of_wire());
  } else {
    m_stepper.exchange(o.device, o.electrode->lead(), o.electrode->hold_of_wire());
  }
  m_stepper.set_friction(o.device, m_options.friction, m_options.tip_hold);
  o.in_cannula = false;
}

void Procedure::apply(const Stage& stage) {
  set_loads(stage);
  if (stage.action == Action::insert_cannula) insert_cannula(stage.side);
  if (stage.action == Action::insert_lead) insert_lead(stage.side);
  if (stage.action == Action::remove_cannula) remove_cannula(stage.side);
}

// In time the head comes to rest by damping of its mass; what is left of the way is below what counts.
SolveReport Procedure::solve() {
  if (m_options.time_step == 0.0) return m_stepper.solve_static();
  constexpr int most = 400;
  constexpr double resting = 1e-3;   // mm per step
  SolveReport last;
  for (int i = 0; i < most; ++i) {
    const Points before = m_stepper.displacement();
    const SolveReport now = m_stepper.step(m_options.time_step);
    const double seconds = last.seconds;
    const int iterations = last.iterations;
    last = now;
    last.seconds += seconds;
    last.iterations += iterations;
    if (!now.converged()) return last;
    if ((m_stepper.displacement() - before).rowwise().norm().maxCoeff() < resting) return last;
  }
  last.status = Status::not_converged;
  last.message = "the head did not come to rest in " + std::to_string(most) + " steps";
  return last;
}

StageResult Procedure::run(const Stage& stage) {
  StageResult result{};
  result.label = stage.label;
  result.title = stage.title;
  std::size_t place = 0;
  for (std::size_t i = 0; i < m_plan.size(); ++i) {
    if (m_plan[i].label == stage.label) place = i;
  }
  result.time = double(place);
  if (m_watcher) m_watcher->stage_begins(m_plan, place);
  apply(stage);
  result.report = solve();
  if (stage.action == Action::none && result.report.converged()) {
    m_tissue.set_reference(m_stepper);
    for (int side : {left, right}) {
      Operated& o = m_side[side];
      o.lost_before = m_stepper.compartment(m_stepper.csf().find(name_of(side))).lost_volume;
      if (o.goal) o.goal_at_rest = tissue_at(o.goal->point);
    }
  }
  if (result.report.converged()) mark(stage);
  m_tissue.fill(m_stepper, result);
  if (m_options.estimate && result.report.converged()) m_tissue.estimate_errors(m_stepper, result);
  for (int side : {left, right}) result.fluid[side].lost_volume -= m_side[side].lost_before;
  for (int side : {left, right}) {
    if (m_side[side].device >= 0) result.lead[side] = measure_lead(side);
  }
  result.remark = remark_on(result);
  if (m_watcher && result.report.converged()) m_watcher->stage_ends();
  return result;
}

// The tissue that is at a point now, in the mesh as given; the point itself where there is none.
Vec3 Procedure::tissue_at(const Vec3& point) const {
  const PointValues rest = m_stepper.rest_points_of(point.transpose());
  return rest.tet.front() < 0 ? point : Vec3(rest.values.row(0).transpose());
}

// Keeps where things were when later stages will ask how far they moved.
void Procedure::mark(const Stage& stage) {
  Operated& o = m_side[stage.side];
  const auto tip = [&](const Operated& of) {
    return Vec3(m_stepper.device(of.device).nodes.row(0).transpose());
  };
  if (stage.action == Action::insert_cannula || stage.action == Action::insert_lead) {
    o.track = m_stepper.device(o.device).path;
  }
  if (stage.action != Action::remove_cannula) return;
  o.released.emplace(m_stepper, tip(o));
  if (!ends_surgery(stage)) return;
  for (Operated& side : m_side) {
    if (side.device >= 0 && !side.closed) side.closed.emplace(m_stepper, tip(side));
  }
}

bool Procedure::ends_surgery(const Stage& stage) const {
  for (std::size_t i = 0; i + 1 < m_plan.size(); ++i) {
    if (m_plan[i].label == stage.label) return m_plan[i + 1].action == Action::restore;
  }
  return false;
}

LeadResult Procedure::measure_lead(int side) const {
  const Operated& o = m_side[side];
  LeadResult r{m_stepper.device(o.device), *o.trajectory, Vec3::Zero(), o.in_cannula, Vec3::Zero(),
               0.0, {}, {}};
  const Vec3& outward = r.trajectory.outward;
  for (Eigen::Index p = 0; p < o.track.rows(); ++p) {
    const Vec3 moved = (r.state.path.row(p) - o.track.row(p)).transpose();
    r.track_motion += moved / double(o.track.rows());
    r.largest_track_motion =
        std::max(r.largest_track_motion, (moved - moved.dot(outward) * outward).norm());
  }
  const Vec3 tip = r.state.nodes.row(0).transpose();
  const Points& contacts = r.state.contact_centres;
  const bool at_contact = m_options.contact > 0 && m_options.contact <= contacts.rows();
  const Vec3 meant = at_contact ? Vec3(contacts.row(m_options.contact - 1).transpose()) : tip;
  r.off_target = meant - place_of_goal(side);
  if (o.released) r.since_cannula_left = o.released->since(m_stepper, tip, outward);
  if (o.closed) r.since_surgery = o.closed->since(m_stepper, tip, outward);
  return r;
}

// Gravity drains fluid through a burr hole only down to it.
std::string Procedure::remark_on(const StageResult& result) const {
  std::string remark;
  for (int side : {left, right}) {
    const Operated& o = m_side[side];
    if (!o.trajectory || !result.fluid[side].open) continue;
    const double hole = -m_gravity.normalized().dot(o.trajectory->inner_table);
    const double below = hole - result.fluid[side].head;
    if (below <= 0.0) continue;
    char text[160];
    std::snprintf(text, sizeof text, "%sthe level on the %s lies %.1f mm below its burr hole",
                  remark.empty() ? "" : ", ", name_of(side), below);
    remark += text;
  }
  return remark.empty() ? remark : remark + ": gravity alone would not drain it so far";
}

}  // namespace dbs
