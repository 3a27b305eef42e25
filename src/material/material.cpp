#include "brainshift/material.hpp"

#include <charconv>
#include <cmath>

#include "brainshift/error.hpp"
#include "material/registry.hpp"

namespace brainshift {
namespace {

// "poisson = 0.5", whatever the locale of the host.
std::string stated(const char* name, double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  return std::string("Material: ") + name + " = " + std::string(digits, end);
}

void require_finite(const char* name, double value) {
  if (!std::isfinite(value)) {
    throw Error(ErrorCode::not_finite, stated(name, value) + " is not finite");
  }
}

void require(bool condition, const char* name, double value, const char* range) {
  if (!condition)
    throw Error(ErrorCode::invalid_argument, stated(name, value) + " is not " + range);
}

}  // namespace

Material::Material(Law law, double young, double poisson, double density)
    : m_law(law), m_young(young), m_poisson(poisson), m_density(density) {
  law_functions(law);  // throws for a law that does not exist
  require_finite("young", young);
  require_finite("poisson", poisson);
  require_finite("density", density);
  require(young > 0.0, "young", young, "positive");
  require(poisson > -1.0 && poisson < 0.5, "poisson", poisson, "inside (-1, 0.5)");
  require(density >= 0.0, "density", density, "zero or more");
  require(std::isfinite(mu()) && std::isfinite(lambda()) && mu() > 0.0, "young", young,
          "in the range of double for the moduli it gives");
}

double Material::energy(const Mat3& gradient) const {
  return law_functions(m_law).energy(lame_of(*this), gradient);
}

Mat3 Material::stress(const Mat3& gradient) const {
  return law_functions(m_law).stress(lame_of(*this), gradient);
}

Eigen::Matrix<double, 9, 9> Material::tangent(const Mat3& gradient, bool definite) const {
  Mat3 P;
  Mat9 A;
  law_functions(m_law).tangent(lame_of(*this), gradient, definite, P, A);
  return A;
}

}  // namespace brainshift
