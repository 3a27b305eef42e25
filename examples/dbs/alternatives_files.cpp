// What is said of the alternatives: a table on the screen, plan.json.
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "alternatives.hpp"
#include "results.hpp"

namespace dbs {
namespace {

nlohmann::json to_json(const Alternative& a, double mean_as_asked) {
  nlohmann::json sides = nlohmann::json::object();
  for (const auto& [side, m] : a.miss) {
    sides[name_of(side)] = {{"off_mm", {m.off.x(), m.off.y(), m.off.z()}},
                            {"along_mm", m.along}, {"across_mm", m.across},
                            {"distance_mm", m.off.norm()}};
  }
  nlohmann::json json = {{"choice", a.name}, {"options", a.words}, {"message", a.message},
                         {"sides", sides}};
  if (std::isfinite(a.mean())) {
    json["mean_mm"] = a.mean();
    json["gain_mm"] = mean_as_asked - a.mean();
  }
  return json;
}

}  // namespace

void print_alternative_header() {
  std::printf("Where the planned contact ends up, from the tissue of its target, once the fluid is back; "
              "mm,\nalong the trajectory positive towards the burr hole.\n\n");
  std::printf("%-22s|%-22s|%-22s| mean  gain\n%-22s|%7s%7s%8s|%7s%7s%8s|\n", "choice", " right", " left",
              "", "along", "across", "off", "along", "across", "off");
}

void print_alternative(const Alternative& a, double mean_as_asked) {
  std::printf("%-22s", a.name.c_str());
  for (int side : {right, left}) {
    const auto found = a.miss.find(side);
    if (found == a.miss.end()) {
      std::printf("|%7s%7s%8s", "-", "-", "-");
    } else {
      const Miss& m = found->second;
      std::printf("|%7.2f%7.2f%8.2f", m.along, m.across, m.off.norm());
    }
  }
  if (a.miss.empty()) {
    std::printf("| %s\n", a.message.c_str());
  } else {
    std::printf("|%5.2f%6.2f\n", a.mean(), mean_as_asked - a.mean());
  }
  std::fflush(stdout);
}

void write_alternatives(const std::string& folder, const std::vector<Alternative>& alternatives) {
  const double asked = alternatives.front().mean();
  nlohmann::json json;
  json["frame"] = "RAS";
  json["best"] = best_of(alternatives).name;
  for (const Alternative& a : alternatives) json["alternatives"].push_back(to_json(a, asked));
  write_whole(folder + "/plan.json", json.dump(1) + "\n");
}

}  // namespace dbs
