#include "alternatives.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

namespace dbs {
namespace {

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g", value);
  return buffer;
}

std::string words_of(const Options& base, const Options& o) {
  std::string words;
  if (o.first != base.first) words += " --first " + o.first;
  if (o.recover_between != base.recover_between) {
    words += o.recover_between ? " --recover-between" : " --one-session";
  }
  if (o.slack != base.slack) words += " --slack " + text(o.slack);
  if (o.aim != base.aim) words += " --aim " + o.aim;
  const auto offset = [&words](const char* name, const std::vector<double>& was,
                               const std::vector<double>& is) {
    if (was == is) return;
    words += name;
    for (double x : is) words += " " + text(x);
  };
  offset(" --offset-right", base.offset_right, o.offset_right);
  offset(" --offset-left", base.offset_left, o.offset_left);
  return words.empty() ? words : words.substr(1);
}

// Moves the aim of each side by minus what it missed by, as the command line would write it.
void undo(const Alternative& from, bool depth_only, const Head& head, Options& o) {
  for (const auto& [side, miss] : from.miss) {
    std::vector<double>& offset = side == right ? o.offset_right : o.offset_left;
    if (offset.empty()) offset = {0.0, 0.0, 0.0};
    const Vec3 outward = plan_goal(head, o, side).outward;
    const Vec3 back = depth_only ? Vec3(miss.along * outward) : miss.off;
    for (int k = 0; k < 3; ++k) {
      offset[std::size_t(k)] = 1e-3 * std::round(1e3 * (offset[std::size_t(k)] - back[k]));
    }
  }
}

constexpr double slacks[] = {0.0, 1.0, 2.0, 4.0};   // mm
constexpr double settled = 0.02;   // mm; far below what imaging resolves: nothing is left to undo

class Search {
 public:
  Search(const Head& head, const Options& options,
         const std::function<void(const Alternative&)>& done, Watcher* watcher)
      : m_head(head), m_asked(options), m_done(done), m_procedure(head, options, watcher) {}

  std::vector<Alternative> run() {
    Start start = begin();
    try_order(start);
    Alternative best = best_of(m_found);
    start = m_starts.at(best.options.first + (best.options.recover_between ? "+" : ""));
    best = try_slack(start, best);
    best = try_aim(start, best);
    best = correct("depth", start, best, true);
    best = correct("aim point", start, best, false);
    correct("aim point again", start, best, false);
    return m_found;
  }

 private:
  using Saved = std::shared_ptr<const Procedure::Branch>;
  struct Start {
    Saved branch;
    std::size_t next;   // stage of its plan
  };

  // Up to where the first surgeon's choice is to be made.
  Start begin() {
    const auto& plan = m_procedure.plan();
    std::size_t next = 0;
    while (next < plan.size() && (plan[next].action == Action::none ||
                                  plan[next].action == Action::turn_head)) {
      run_stage(plan[next++]);
    }
    return {m_procedure.branch(), next};
  }

  const StageResult& run_stage(const Stage& stage) {
    m_last = m_procedure.run(stage);
    if (m_last->report.status == Status::cancelled) throw Interrupted{};
    if (!m_last->report.converged()) {
      throw Error(ErrorCode::invalid_argument, "stage " + stage.label + ": " + m_last->report.message);
    }
    return *m_last;
  }

  // Runs the rest of the procedure; `before_insertion` takes the state before the first device.
  Alternative attempt(const std::string& name, const Options& options, const Start& start,
                      Start* before_insertion = nullptr) {
    Alternative a{name, options, words_of(m_asked, options), "", {}};
    try {
      m_procedure.go_back_to(start.branch);
      m_procedure.replan(options);
      const std::vector<Stage> plan = m_procedure.plan();
      for (std::size_t i = start.next; i < plan.size(); ++i) {
        if (before_insertion && plan[i].action == Action::insert_cannula) {
          *before_insertion = {m_procedure.branch(), i};
          before_insertion = nullptr;
        }
        run_stage(plan[i]);
      }
      for (int side : {left, right}) {
        if (!m_last->lead[side]) continue;
        const LeadResult& lead = *m_last->lead[side];
        const Vec3& t = lead.trajectory.outward;
        const double along = lead.off_target.dot(t);
        a.miss[side] = {lead.off_target, along, (lead.off_target - along * t).norm()};
      }
    } catch (const Error& e) {
      if (m_found.empty()) throw;   // what was asked for cannot be
      a.message = e.what();
      a.miss.clear();
    }
    m_found.push_back(a);
    m_done(a);
    return a;
  }

  void try_order(const Start& start) {
    const auto go = [&](const char* name, const Options& o) {
      attempt(name, o, start, &m_starts[o.first + (o.recover_between ? "+" : "")]);
    };
    go("as asked", m_asked);
    if (m_asked.sides != "both") return;
    Options o = m_asked;
    o.first = m_asked.first == "right" ? "left" : "right";
    go("other side first", o);
    o = m_asked;
    o.recover_between = !m_asked.recover_between;
    go(o.recover_between ? "recovery in between" : "one session", o);
  }

  Alternative better(const Alternative& a, const Alternative& b) {
    return b.mean() < a.mean() ? b : a;
  }

  Alternative try_slack(const Start& start, Alternative best) {
    const Options base = best.options;
    for (double slack : slacks) {
      if (slack == base.slack) continue;
      Options o = base;
      o.slack = slack;
      best = better(best, attempt("slack " + text(slack) + " mm", o, start));
    }
    return best;
  }

  Alternative try_aim(const Start& start, const Alternative& best) {
    Options o = best.options;
    o.aim = o.aim == "skull" ? "tissue" : "skull";
    return better(best, attempt("aim at the " + o.aim, o, start));
  }

  Alternative correct(const char* name, const Start& start, const Alternative& best,
                      bool depth_only) {
    if (!(best.mean() > settled)) return best;
    Options o = best.options;
    undo(best, depth_only, m_head, o);
    return better(best, attempt(name, o, start));
  }

  const Head& m_head;
  const Options m_asked;
  const std::function<void(const Alternative&)>& m_done;
  Procedure m_procedure;
  std::optional<StageResult> m_last;
  std::map<std::string, Start> m_starts;   // by order of sides
  std::vector<Alternative> m_found;
};

}  // namespace

double Alternative::mean() const {
  if (miss.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const auto& [side, m] : miss) sum += m.off.norm();
  return sum / double(miss.size());
}

const Alternative& best_of(const std::vector<Alternative>& alternatives) {
  const Alternative* best = &alternatives.front();
  for (const Alternative& a : alternatives) {
    if (a.mean() < best->mean()) best = &a;
  }
  return *best;
}

int most_alternatives(const Options& options) {
  const int orders = options.sides == "both" ? 3 : 1;
  const auto other = [&](double slack) { return slack != options.slack; };
  constexpr int aims = 1, corrections = 3;
  return orders + int(std::count_if(std::begin(slacks), std::end(slacks), other)) + aims + corrections;
}

std::vector<Alternative> search_alternatives(
    const Head& head, const Options& options,
    const std::function<void(const Alternative&)>& done, Watcher* watcher) {
  if (!options.devices) {
    throw Error(ErrorCode::invalid_argument, "--plan and --no-devices: there is nothing to plan");
  }
  return Search(head, options, done, watcher).run();
}

}  // namespace dbs
