// Procedure: which stages there will be, and whether they can be.
#include "procedure.hpp"

namespace dbs {

// Sides that already have a device keep it and the line it is on.
void Procedure::plan_sides() {
  for (int side : {left, right}) {
    Operated& o = m_side[side];
    if (o.device >= 0) continue;
    o.trajectory.reset();
    o.electrode.reset();
    if (m_options.sides != "both" && m_options.sides != name_of(side)) continue;
    const Goal goal = plan_goal(m_head, m_options, side);
    if (!o.goal) o.goal_at_rest = goal.point;
    o.goal = goal;
    o.trajectory = aim_at(m_head, m_options, side, goal.point, goal.outward);
    if (m_options.devices) o.electrode.emplace(m_options, *o.trajectory);
  }
}

std::vector<Stage> Procedure::make_plan() const {
  std::vector<Stage> stages{{"0", "before surgery", Action::none, right}};
  if (imaging_elevation(m_options) != m_options.elevation) {
    stages.push_back({"0b", "head elevated", Action::turn_head, right});
  }
  const auto add = [&](const char* label, int side, const char* what, Action action) {
    stages.push_back({label, name_of(side) + std::string(", ") + what, action, side});
  };
  // The second side repeats the first one's stages 1 to 3 as its sixth.
  const int sides[2] = {m_options.first == "left" ? left : right,
                        m_options.first == "left" ? right : left};
  const char* labels[2][5] = {{"1", "2", "3", "4", "5"}, {"6a", "6b", "6c", "7", "8"}};
  for (int side : sides) {
    const bool loss = is_operated(side) && m_loss[side].amount > 0.0;
    const bool lead = m_side[side].electrode.has_value();
    const bool second = side != sides[0];
    if (second && m_options.recover_between && m_side[sides[0]].electrode && (loss || lead)) {
      add("5b", sides[0], "CSF restored", Action::restore);
    }
    if (loss) add(labels[second][0], side, "craniotomy", Action::lose_fluid);
    if (lead) add(labels[second][1], side, "cannula in", Action::insert_cannula);
    if (lead) add(labels[second][2], side, "electrode in", Action::insert_lead);
    if (loss && m_options.late > 0.0) add(labels[second][3], side, "testing", Action::test);
    if (lead) add(labels[second][4], side, "cannula out", Action::remove_cannula);
  }
  stages.push_back({"9", "CSF restored", Action::restore, right});
  return stages;
}

// One fluid can be asked for in one way only.
void Procedure::check_losses() const {
  const bool both = is_operated(left) && is_operated(right) && m_loss[left].amount > 0.0 &&
                    m_loss[right].amount > 0.0;
  const bool one_fluid = m_stepper.csf().model() == FluidModel::communicating;
  if (both && one_fluid && m_loss[left].law != m_loss[right].law) {
    throw Error(ErrorCode::fluid_volume,
                "--right " + m_options.right + " and --left " + m_options.left +
                    " are of different kinds, and the communicating fluid is one: ask for both in mL, "
                    "mL-air or mm, or for --fluid separate");
  }
}

void Procedure::check_plan() {
  const auto before = m_stepper.snapshot();
  for (const Stage& stage : m_plan) {
    set_loads(stage);
    m_stepper.check_settings();
  }
  m_stepper.restore(before);
  for (const Operated& side : m_side) {
    if (!side.electrode || side.device >= 0) continue;
    const Electrode& e = *side.electrode;
    e.lead_in_cannula(m_options.lead);
    m_stepper.insert(e.lead(), {e.trajectory().target, e.trajectory().outward}, e.hold_of_wire(),
                     e.track());
  }
  m_stepper.restore(before);
}

std::shared_ptr<const Procedure::Branch> Procedure::branch() const {
  return std::make_shared<Branch>(Branch{m_stepper.snapshot(), m_side, m_options, m_plan});
}

void Procedure::go_back_to(const std::shared_ptr<const Branch>& branch) {
  m_stepper.restore(branch->state);
  m_side = branch->side;
  m_options = branch->options;
  m_plan = branch->plan;
}

void Procedure::replan(const Options& options) {
  const auto before = branch();
  try {
    m_options = options;
    plan_sides();
    m_plan = make_plan();
    check_plan();
  } catch (...) {
    go_back_to(before);
    throw;
  }
}

}  // namespace dbs
