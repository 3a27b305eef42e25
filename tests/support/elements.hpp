// Every element, for tests that hold for each of them.
#pragma once

#include <string>
#include <utility>

#include "brainshift/stepper.hpp"

namespace brainshift::test {

enum class Element { linear, nodal_volume, quadratic };

constexpr Element all_elements[] = {Element::linear, Element::nodal_volume, Element::quadratic};

inline std::string name_of(Element element) {
  return element == Element::linear      ? "linear"
         : element == Element::quadratic ? "quadratic"
                                         : "nodal volume";
}

// A scene of linear tets with another element; nodes of the linear mesh keep their numbers.
inline Scene with_element(Scene scene, Element element) {
  if (element == Element::quadratic) return quadratic(scene);
  if (element == Element::nodal_volume) scene.volume_strain = VolumeStrain::nodal;
  return scene;
}

}  // namespace brainshift::test
