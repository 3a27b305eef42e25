// Which choices of the surgeon leave the electrodes nearest their targets once the fluid is back.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "procedure.hpp"

namespace dbs {

// Where the planned contact ends up, from the tissue of its target, after the last stage (mm).
struct Miss {
  Vec3 off;
  double along;    // towards the burr hole
  double across;
};

struct Alternative {
  std::string name;
  Options options;
  std::string words;            // what to add to the command line to repeat it
  std::string message;          // empty where every stage found its balance
  std::map<int, Miss> miss;     // by Side; empty without a balance
  double mean() const;          // over the sides (mm); infinity without a balance
};

// Goes through order of sides, slack and aim one at a time, then depth and aim point that undo what is
// left, each as a branch of one procedure; `done` is told each in turn. The first is `options` itself.
// Throws brainshift::Error where `options` has no electrodes or cannot be, and Interrupted where the
// watcher ended a solve.
std::vector<Alternative> search_alternatives(const Head& head, const Options& options,
                                             const std::function<void(const Alternative&)>& done,
                                             Watcher* watcher = nullptr);
struct Interrupted {};
// How many the search will try at most.
int most_alternatives(const Options& options);

// Least mean; the earlier of equals.
const Alternative& best_of(const std::vector<Alternative>& alternatives);

void print_alternative_header();
void print_alternative(const Alternative& alternative, double mean_as_asked);
// plan.json
void write_alternatives(const std::string& folder, const std::vector<Alternative>& alternatives);

}  // namespace dbs
