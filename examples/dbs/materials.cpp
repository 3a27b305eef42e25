#include "materials.hpp"

#include <algorithm>
#include <fstream>
#include <limits>

#include <nlohmann/json.hpp>

#include "head.hpp"
#include "scene.hpp"

namespace dbs {
namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(const std::string& source, const std::string& what) {
  throw Error(ErrorCode::file, source + ": " + what);
}

bool is_label(const Json& value) {
  constexpr std::int64_t largest = std::numeric_limits<Index>::max();
  return value.is_number_integer() && value.get<std::int64_t>() >= -largest &&
         value.get<std::int64_t>() <= largest;
}

std::pair<Index, Index> read_range(const Json& value, const std::string& source) {
  if (is_label(value)) return {value.get<Index>(), value.get<Index>()};
  const bool pair = value.is_array() && value.size() == 2 && is_label(value[0]) && is_label(value[1]);
  if (!pair || value[0].get<Index>() > value[1].get<Index>()) {
    refuse(source, "'labels' holds " + value.dump() + ": write a whole number, or [first, last]");
  }
  return {value[0].get<Index>(), value[1].get<Index>()};
}

std::optional<double> read_number(const Json& entry, const char* key, const std::string& source) {
  if (!entry.contains(key)) return {};
  if (!entry[key].is_number()) refuse(source, std::string("'") + key + "' is no number");
  return entry[key].get<double>();
}

void check_keys(const Json& entry, const std::string& source) {
  static const std::vector<std::string> known = {"name", "labels", "young_kPa", "poisson",
                                                 "density_kg_m3", "law"};
  for (const auto& item : entry.items()) {
    if (std::find(known.begin(), known.end(), item.key()) != known.end()) continue;
    refuse(source, "unknown key '" + item.key() +
                       "'; known: name, labels, young_kPa, poisson, density_kg_m3, law");
  }
}

Part read_part(const Json& entry, const std::string& path, std::size_t number) {
  const std::string nth = path + ": material " + std::to_string(number);
  if (!entry.is_object()) refuse(nth, "write an object with name and labels");
  if (entry.contains("name") && !entry["name"].is_string()) refuse(nth, "'name' is no word");
  Part part;
  part.name = entry.value("name", "material " + std::to_string(number));
  part.source = path + ": '" + part.name + "'";
  check_keys(entry, part.source);
  const Json labels = entry.value("labels", Json());
  if (!labels.is_array() || labels.empty()) refuse(part.source, "needs 'labels', a list of whole numbers");
  for (const Json& value : labels) part.labels.push_back(read_range(value, part.source));
  part.young = read_number(entry, "young_kPa", part.source);
  part.poisson = read_number(entry, "poisson", part.source);
  part.density = read_number(entry, "density_kg_m3", part.source);
  if (entry.contains("law")) {
    if (!entry["law"].is_string()) refuse(part.source, "'law' is no word");
    try {
      part.law = law_from_name(entry["law"]);
    } catch (const Error& e) {
      refuse(part.source, e.what());
    }
  }
  return part;
}

Material material_of(const Part& part, const Head& head, const Options& o) {
  try {
    return Material(part.law.value_or(law_from_name(o.law)), part.young.value_or(o.young),
                    part.poisson.value_or(o.poisson),
                    part.density ? *part.density * 1e-9 : density_of(head, o));
  } catch (const Error& e) {
    throw Error(e.code(), part.source + ": " + e.what());
  }
}

void check_overlap(const std::vector<Part>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (const auto& [first, last] : parts[i].labels) {
        for (const auto& [a, b] : parts[j].labels) {
          if (first > b || a > last) continue;
          refuse(parts[i].source, "label " + std::to_string(std::max(first, a)) + " stands in " +
                                      parts[j].source + " too: keep one of them");
        }
      }
    }
  }
}

// Of each tet: its part's region, or its side's.
Indices regions_of(const Head& head, const std::vector<Part>& parts) {
  Indices regions = head.brain.regions();
  std::vector<char> found(parts.size(), 0);
  for (std::size_t t = 0; t < regions.size(); ++t) {
    const auto part = std::find_if(parts.begin(), parts.end(),
                                   [&](const Part& p) { return p.has(head.labels[t]); });
    if (part == parts.end()) continue;
    const auto number = part - parts.begin();
    found[std::size_t(number)] = 1;
    regions[t] = BrainMaterials::region_of_part(std::size_t(number));
  }
  const auto missing = std::find(found.begin(), found.end(), 0) - found.begin();
  if (missing < std::ptrdiff_t(parts.size())) {
    refuse(parts[std::size_t(missing)].source, "no tet of the head has one of its labels: correct them, or "
           "mesh the head finer");
  }
  return regions;
}

// A region without tets has no say in what is stiffest or softest.
void drop_unused(BrainMaterials& brain) {
  auto& all = brain.of_region;
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const auto& m) { return brain.mesh.volume(m.first) == 0.0; }),
            all.end());
}

}  // namespace

bool Part::has(Index label) const {
  return std::any_of(labels.begin(), labels.end(),
                     [label](const auto& range) { return range.first <= label && label <= range.second; });
}

std::vector<Part> read_parts(const std::string& path) {
  std::ifstream file(path);
  if (!file) refuse(path, "cannot be read");
  const Json json = Json::parse(file, nullptr, false);
  if (json.is_discarded() || !json.is_object() || !json.contains("materials") || !json["materials"].is_array()) {
    refuse(path, "is not JSON with a list 'materials'");
  }
  std::vector<Part> parts;
  for (const Json& entry : json["materials"]) parts.push_back(read_part(entry, path, parts.size() + 1));
  check_overlap(parts);
  return parts;
}

Index BrainMaterials::region_of_part(std::size_t number) { return Head::region(right) + 1 + Index(number); }

const Material& BrainMaterials::of(Index region) const {
  return std::find_if(of_region.begin(), of_region.end(),
                      [region](const auto& m) { return m.first == region; })->second;
}

double BrainMaterials::mass() const {
  double sum = 0.0;
  for (const auto& [region, material] : of_region) sum += material.density() * mesh.volume(region);
  return sum;
}

BrainMaterials materials_of(const Head& head, const Options& o) {
  const Material tissue(law_from_name(o.law), o.young, o.poisson, density_of(head, o));
  BrainMaterials result{head.brain, {{Head::region(left), tissue}, {Head::region(right), tissue}}};
  if (head.parts.empty()) return result;
  if (head.labels.empty()) {
    refuse(head.parts.front().source, "the head's brain.vtu has no array 'label' of its tets: make the head "
           "with examples/own_head");
  }
  result.mesh = Mesh(head.brain.nodes(), head.brain.tets(), regions_of(head, head.parts));
  for (std::size_t i = 0; i < head.parts.size(); ++i) {
    const Part& part = head.parts[i];
    if (part.density && o.mass > 0.0) {
      throw Error(ErrorCode::invalid_argument, part.source + ": has a density, and --mass sets one for all: "
                  "leave one of them out");
    }
    result.of_region.emplace_back(BrainMaterials::region_of_part(i), material_of(part, head, o));
  }
  drop_unused(result);
  return result;
}

}  // namespace dbs
