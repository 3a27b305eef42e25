// Materials of parts of the brain, by the labels of its tets.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "brainshift/brainshift.hpp"

namespace dbs {

using namespace brainshift;

struct Head;
struct Options;

// What is left out is that of the options.
struct Part {
  std::string name, source;   // source: "FILE: 'name'"
  std::vector<std::pair<Index, Index>> labels;   // first and last
  std::optional<double> young, poisson, density;   // kPa, 1, kg/m^3
  std::optional<Law> law;

  bool has(Index label) const;
};

// Reads a JSON file (docs/file-formats.md); throws Error(file) naming file, part and what to fix.
std::vector<Part> read_parts(const std::string& path);

// What each tet is made of. Regions: a side's, as in Head, or a part's.
struct BrainMaterials {
  Mesh mesh;
  std::vector<std::pair<Index, Material>> of_region;

  static Index region_of_part(std::size_t number);
  const Material& of(Index region) const;
  const Material& of_tet(Index t) const { return of(mesh.regions()[std::size_t(t)]); }
  double mass() const;   // kg
};

// Throws Error naming the part: values that are no material, a label given twice or without a tet,
// labels that the head does not have.
BrainMaterials materials_of(const Head& head, const Options& options);

}  // namespace dbs
