// How far the program is: a line on the terminal, or one JSON object per line.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "procedure.hpp"

namespace dbs {

enum class ProgressStyle { silent, line, json };

// Of --progress and --quiet; "auto" is a line where stderr is a terminal and nothing elsewhere.
ProgressStyle progress_style(const Options& options);

// Watches one procedure, or as many as a search for alternatives will try at most. The fraction counts
// Newton iterations, done against expected, and never falls; what remains is told from the time so far.
// Writes to stderr.
class ProgressMeter : public Watcher {
 public:
  // stop: whether to end at the next iteration.
  ProgressMeter(const Options& options, int procedures, std::function<bool()> stop);

  void stage_begins(const std::vector<Stage>& plan, std::size_t stage) override;
  bool goes_on(const Progress& solve) override;
  void stage_ends() override;
  void procedure_ends();   // the next stage is of the next one
  // The last word. event: "done", "interrupted", "failed"; the fraction is 1 only when done.
  void end(const char* event);

 private:
  void advance_to(double part_of_stage);
  void say(const char* event);
  void say_on_one_line() const;
  double elapsed() const;
  double remaining() const;   // s; NaN: too early to tell

  ProgressStyle m_style;
  std::function<bool()> m_stop;
  std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
  double m_expected_scale;    // of the iterations of a stage
  int m_procedures, m_ended = 0;
  std::vector<Stage> m_plan;
  std::size_t m_stage = 0;
  int m_iterations = 0;       // of the stage
  double m_fraction = 0.0;
  Progress m_solve{0.0, 0, 0.0};
};

// What ends the program, as a sentence or as an object.
void say_error(ProgressStyle style, const std::string& message);

}  // namespace dbs
