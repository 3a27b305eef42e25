#include "case.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "accuracy/refined_head.hpp"
#include "clock.hpp"
#include "procedure.hpp"

namespace bench {
namespace {

using namespace dbs;

Options options_of(const Case& wanted) {
  Options o;
  o.law = wanted.law;
  o.element = wanted.element;
  o.poisson = wanted.poisson;
  o.accuracy = wanted.accuracy;
  o.threads = wanted.threads;
  o.left = o.right = std::to_string(air) + "mL-air";
  if (wanted.one_linearisation) {   // the first iterate is within any of them
    o.solver.residual_tolerance = o.solver.complementarity_tolerance = 10.0;
    o.solver.correction_tolerance = 1e9;
  }
  return o;
}

StepperOptions stepper_options(const Options& o, const Mesh& mesh) {
  StepperOptions stepper = o.solver;
  stepper.threads = o.threads;
  return o.accuracy > 0.0 ? within(o.accuracy, mesh, std::move(stepper)) : stepper;
}

std::vector<Vec3> rows_of(const Points& points) {
  std::vector<Vec3> rows;
  for (Eigen::Index i = 0; i < points.rows(); ++i) rows.push_back(points.row(i).transpose());
  return rows;
}

// What is right of the brain alone loses fluid, as in the procedure's first two stages.
Outcome lose_fluid(const Head& given, const Case& wanted, const Points& points) {
  const std::optional<Head> fine = wanted.refinements > 0 ? std::optional(refined(given)) : std::nullopt;
  const Head& head = fine ? *fine : given;
  const Options options = options_of(wanted);
  Outcome outcome;
  const Clock setup;
  SceneIds ids;
  Scene scene = make_scene(head, options, ids);
  if (fine) let_touch(scene, ids.skull);
  const StepperOptions solver = stepper_options(options, scene.mesh);
  Stepper stepper(std::move(scene), solver);
  outcome.setup_cpu = setup.cpu();
  const Clock clock;
  const auto keep = [&](const char* stage, const SolveReport& report, const Points& before) {
    outcome.stages.push_back({stage, report, {}, {}});
    outcome.stages.back().shift = rows_of(stepper.displacement_at(points).values - before);
    return report.converged();
  };
  bool balanced = keep("0", stepper.solve_static(), Points::Zero(points.rows(), 3));
  const Points before = stepper.displacement_at(points).values;
  const double loss = (1.0 - options.late) * air * mm3_per_ml;
  for (int i = 1; balanced && i <= wanted.load_steps; ++i) {
    stepper.csf().set_air_volume(stepper.csf().find(name_of(right)), loss * i / wanted.load_steps);
    const SolveReport report = stepper.solve_static();
    const std::string part = i < wanted.load_steps ? "1, part " + std::to_string(i) : "1";
    balanced = keep(part.c_str(), report, before);
  }
  outcome.cpu = clock.cpu();
  outcome.wall = clock.wall();
  outcome.nodes = stepper.mesh().node_count();
  outcome.tets = stepper.mesh().tet_count();
  return outcome;
}

Outcome operate(const Head& head, const Case& wanted, const Points& points) {
  if (wanted.refinements > 0 || wanted.load_steps != 1) {
    throw Error(ErrorCode::invalid_argument,
                "the scene procedure is done on the head as given and in one solve for each stage: take out "
                "refinements and load_steps, or ask for the scene csf_loss");
  }
  Outcome outcome;
  const Clock setup;
  Procedure procedure(head, options_of(wanted));
  outcome.setup_cpu = setup.cpu();
  const Clock clock;
  Points before = Points::Zero(points.rows(), 3);
  for (const Stage& stage : procedure.plan()) {
    const StageResult result = procedure.run(stage);
    const Points now = procedure.stepper().displacement_at(points).values;
    if (stage.action == Action::none) before = now;
    outcome.stages.push_back({stage.label, result.report, rows_of(now - before), {}});
    for (int side : {left, right}) {
      if (!result.lead[side]) continue;
      const LeadResult& lead = *result.lead[side];
      outcome.stages.back().tips.emplace_back(
          std::string("tip_") + name_of(side),
          Vec3(lead.state.nodes.row(0).transpose()) - lead.trajectory.target);
    }
    if (!result.report.converged()) break;
  }
  outcome.cpu = clock.cpu();
  outcome.wall = clock.wall();
  outcome.nodes = procedure.stepper().mesh().node_count();
  outcome.tets = procedure.stepper().mesh().tet_count();
  return outcome;
}

template <class T>
void take(const nlohmann::json& value, const std::string& key, T& into) {
  try {
    value.get_to(into);
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorCode::invalid_argument, "the value of \"" + key + "\" is of another type: " + value.dump());
  }
}

}  // namespace

Case case_from(const nlohmann::json& json) {
  Case c;
  for (const auto& [key, value] : json.items()) {
    if (key == "head") take(value, key, c.head);
    else if (key == "scene") take(value, key, c.scene);
    else if (key == "law") take(value, key, c.law);
    else if (key == "element") take(value, key, c.element);
    else if (key == "poisson") take(value, key, c.poisson);
    else if (key == "accuracy") take(value, key, c.accuracy);
    else if (key == "one_linearisation") take(value, key, c.one_linearisation);
    else if (key == "load_steps") take(value, key, c.load_steps);
    else if (key == "threads") take(value, key, c.threads);
    else if (key == "refinements") take(value, key, c.refinements);
    else throw Error(ErrorCode::invalid_argument, "a case has no \"" + key + "\"; bench/speed_accuracy/case.hpp has what it has");
  }
  if (c.scene != "csf_loss" && c.scene != "procedure") {
    throw Error(ErrorCode::invalid_argument, "unknown scene '" + c.scene + "'; known: csf_loss, procedure");
  }
  if (c.refinements < 0 || c.refinements > 1 || c.load_steps < 1) {
    throw Error(ErrorCode::invalid_argument, "refinements are 0 or 1, and load_steps 1 at least");
  }
  return c;
}

Outcome run(const Head& head, const Case& wanted, const std::vector<Probe>& probes) {
  const Points points = points_of(probes);
  return wanted.scene == "procedure" ? operate(head, wanted, points) : lose_fluid(head, wanted, points);
}

}  // namespace bench
