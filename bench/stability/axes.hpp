// How far the methods go: one function per axis, each of which writes its table to stdout as CSV.
#pragma once

#include <cstdio>
#include <string>

#include "brainshift/brainshift.hpp"

namespace brainshift::stability {

void compression();
void poisson();
void load_steps();
void time_steps();
void stiffness();
void devices_on_one_track();
void repeated_rows();
void repeated_rows_by_siconos();
// Not an axis: input decks of CalculiX for three of them, one after another.
void calculix_decks();

constexpr double young = 6.0;  // kPa

constexpr Law laws[] = {Law::linear, Law::corotational, Law::st_venant_kirchhoff,
                        Law::stable_neo_hookean, Law::log_neo_hookean};

enum class Element { linear, nodal, quadratic };
constexpr Element elements[] = {Element::linear, Element::nodal, Element::quadratic};

inline const char* to_string(Element element) {
  return element == Element::linear ? "linear" : element == Element::nodal ? "nodal" : "quadratic";
}

// The scene, given with linear tets, with those of `element`.
inline Scene with(Scene scene, Element element) {
  if (element == Element::quadratic) return quadratic(scene);
  scene.volume_strain = element == Element::nodal ? VolumeStrain::nodal : VolumeStrain::element;
  return scene;
}

// A sentence as a field of CSV.
inline std::string quoted(const std::string& sentence) {
  std::string field = "\"";
  for (const char c : sentence) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

}  // namespace brainshift::stability
