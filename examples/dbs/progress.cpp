#include "progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <unistd.h>

#include <nlohmann/json.hpp>

namespace dbs {
namespace {

// Newton iterations a stage takes, roughly: what moves the brain takes most.
double expected_iterations(Action action) {
  switch (action) {
    case Action::none: return 0.5;
    case Action::insert_cannula: return 1.0;
    case Action::insert_lead: return 0.5;
    case Action::turn_head:
    case Action::lose_fluid:
    case Action::test:
    case Action::remove_cannula:
    case Action::restore: return 7.0;
  }
  return 7.0;
}

constexpr double steps_in_time = 30.0;   // a stage goes on for, roughly, in place of one balance

double expected_before(const std::vector<Stage>& plan, std::size_t end) {
  double sum = 0.0;
  for (std::size_t i = 0; i < end; ++i) sum += expected_iterations(plan[i].action);
  return sum;
}

// One write, so that lines of several programs do not mix.
void put_line(const nlohmann::json& object) {
  const auto replace = nlohmann::json::error_handler_t::replace;   // a path may be no UTF-8
  const std::string line = object.dump(-1, ' ', false, replace) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fflush(stderr);
}

void clear_line() { std::fputs("\r\033[K", stderr); }

}  // namespace

ProgressStyle progress_style(const Options& options) {
  if (options.quiet || options.progress == "none") return ProgressStyle::silent;
  if (options.progress == "json") return ProgressStyle::json;
  if (options.progress == "line") return ProgressStyle::line;
  return isatty(STDERR_FILENO) ? ProgressStyle::line : ProgressStyle::silent;
}

ProgressMeter::ProgressMeter(const Options& options, int procedures, std::function<bool()> stop)
    : m_style(progress_style(options)),
      m_stop(std::move(stop)),
      m_expected_scale(options.time_step > 0.0 ? steps_in_time : 1.0),
      m_procedures(procedures) {}

void ProgressMeter::stage_begins(const std::vector<Stage>& plan, std::size_t stage) {
  m_plan = plan;
  m_stage = stage;
  m_iterations = 0;
  m_solve = {0.0, 0, 0.0};
  advance_to(0.0);
  say("stage begins");
}

bool ProgressMeter::goes_on(const Progress& solve) {
  m_solve = solve;
  ++m_iterations;
  const double expected = m_expected_scale * expected_iterations(m_plan[m_stage].action);
  advance_to(1.0 - std::exp(-2.0 * m_iterations / expected));   // below 1 however many there are
  say("iteration");
  return !m_stop();
}

void ProgressMeter::stage_ends() {
  advance_to(1.0);
  say("stage ends");
  if (m_style == ProgressStyle::line) clear_line();   // for the row of the table
}

void ProgressMeter::procedure_ends() { m_ended = std::min(m_ended + 1, m_procedures - 1); }

void ProgressMeter::end(const char* event) {
  if (std::string(event) == "done") m_fraction = 1.0;
  if (m_style == ProgressStyle::line) clear_line();
  if (m_style == ProgressStyle::json) say(event);
}

void ProgressMeter::advance_to(double part_of_stage) {
  const double all = expected_before(m_plan, m_plan.size());
  const double done = expected_before(m_plan, m_stage) +
                      part_of_stage * expected_iterations(m_plan[m_stage].action);
  m_fraction = std::max(m_fraction, (m_ended + done / all) / m_procedures);
}

double ProgressMeter::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
}

double ProgressMeter::remaining() const {
  const bool too_early = m_fraction < 0.02;
  return too_early ? std::numeric_limits<double>::quiet_NaN()
                   : elapsed() * (1.0 - m_fraction) / m_fraction;
}

void ProgressMeter::say(const char* event) {
  if (m_style == ProgressStyle::line) say_on_one_line();
  if (m_style != ProgressStyle::json) return;
  const double left = remaining();
  nlohmann::json object = {{"event", event}, {"fraction", m_fraction}, {"elapsed_s", elapsed()},
                           {"remaining_s", std::isfinite(left) ? nlohmann::json(left) : nlohmann::json()}};
  if (!m_plan.empty()) {
    object["stage"] = m_plan[m_stage].label;
    object["title"] = m_plan[m_stage].title;
    object["stage_number"] = m_stage + 1;
    object["stages"] = m_plan.size();
    object["iteration"] = m_iterations;
    object["residual"] = m_solve.residual;
    object["load_factor"] = m_solve.load_factor;
  }
  if (m_procedures > 1) {
    object["procedure"] = m_ended + 1;
    object["procedures_at_most"] = m_procedures;
  }
  put_line(object);
}

void ProgressMeter::say_on_one_line() const {
  char left[32] = "";
  if (std::isfinite(remaining())) std::snprintf(left, sizeof left, ", %.0f s left", remaining());
  char of[48] = "";
  if (m_procedures > 1) {
    std::snprintf(of, sizeof of, " of choice %d (at most %d)", m_ended + 1, m_procedures);
  }
  clear_line();
  const Stage& stage = m_plan[m_stage];
  std::fprintf(stderr, "%3.0f %%%s; stage %s, %s%s: iteration %d, residual %.0e", 100.0 * m_fraction,
               left, stage.label.c_str(), stage.title.c_str(), of, m_iterations, m_solve.residual);
  std::fflush(stderr);
}

void say_error(ProgressStyle style, const std::string& message) {
  if (style == ProgressStyle::json) {
    put_line({{"event", "error"}, {"message", message}});
  } else {
    if (style == ProgressStyle::line && isatty(STDERR_FILENO)) clear_line();
    std::fprintf(stderr, "dbs: %s\n", message.c_str());
  }
}

}  // namespace dbs
