// What a Material refuses, and what it says.
#include <gtest/gtest.h>

#include <limits>

#include "brainshift/error.hpp"
#include "brainshift/material.hpp"
#include "material/registry.hpp"
#include "support/laws.hpp"

namespace brainshift::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

void expect_refused(Law law, double young, double poisson, double density, ErrorCode code,
                    const std::string& message) {
  try {
    const Material material(law, young, poisson, density);
    FAIL() << "accepted: " << message;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_EQ(error.what(), message);
  }
}

TEST(MaterialValidation, names_the_parameter_and_its_range) {
  const auto invalid = ErrorCode::invalid_argument;
  const Law law = Law::corotational;
  const std::string poisson_range = " is not inside (-1, 0.5)";
  expect_refused(law, 6, 0.5, 0, invalid, "Material: poisson = 0.5" + poisson_range);
  expect_refused(law, 6, 0.6, 0, invalid, "Material: poisson = 0.6" + poisson_range);
  expect_refused(law, 6, -1.0, 0, invalid, "Material: poisson = -1" + poisson_range);
  expect_refused(law, 6, -1.2, 0, invalid, "Material: poisson = -1.2" + poisson_range);
  expect_refused(law, 0, 0.45, 0, invalid, "Material: young = 0 is not positive");
  expect_refused(law, -6, 0.45, 0, invalid, "Material: young = -6 is not positive");
  expect_refused(law, 6, 0.45, -1, invalid, "Material: density = -1 is not zero or more");
}

TEST(MaterialValidation, refuses_what_is_not_finite) {
  const auto code = ErrorCode::not_finite;
  expect_refused(Law::linear, nan, 0.45, 0, code, "Material: young = nan is not finite");
  expect_refused(Law::linear, inf, 0.45, 0, code, "Material: young = inf is not finite");
  expect_refused(Law::linear, 6, nan, 0, code, "Material: poisson = nan is not finite");
  expect_refused(Law::linear, 6, 0.45, -inf, code, "Material: density = -inf is not finite");
}

TEST(MaterialValidation, refuses_moduli_that_overflow_and_laws_that_do_not_exist) {
  EXPECT_THROW(Material(Law::linear, 1e308, 0.4999999, 0), Error);
  EXPECT_THROW(Material(static_cast<Law>(17), 6, 0.45, 0), Error);
}

TEST(MaterialValidation, accepts_the_edges_of_the_range) {
  EXPECT_NO_THROW(Material(Law::linear, 1e-3, -0.999, 0.0));
  EXPECT_NO_THROW(Material(Law::linear, 1e12, 0.4999999, 0.0));
}

TEST(LawNames, there_and_back) {
  for (const Law law : all_laws) {
    EXPECT_EQ(law_from_name(to_string(law)), law);
  }
  EXPECT_EQ(law_from_name("stvk"), Law::st_venant_kirchhoff);
  EXPECT_EQ(law_from_name("snh"), Law::stable_neo_hookean);
  EXPECT_EQ(law_from_name("lnh"), Law::log_neo_hookean);
}

TEST(LawNames, an_unknown_one_is_told_the_known_ones) {
  try {
    law_from_name("ogden");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    EXPECT_STREQ(error.what(),
                 "unknown law 'ogden'; known: linear, corotational, st_venant_kirchhoff (stvk), "
                 "stable_neo_hookean (snh), log_neo_hookean (lnh)");
  }
}

// u/L of a uniaxial test does not depend on the unit of stress.
TEST(MaterialScaling, stress_over_young_is_independent_of_young) {
  Mat3 G = Mat3::Zero();
  G << 0.1, 0.2, 0.0, -0.3, 0.05, 0.1, 0.0, 0.2, -0.1;
  for (const Law law : all_laws) {
    const Mat3 reference = Material(law, 1.0, 0.45, 0.0).stress(G);
    for (const double young : {1e-3, 1e12}) {
      const Mat3 P = Material(law, young, 0.45, 0.0).stress(G) / young;
      EXPECT_LE((P - reference).norm(), 1e-14 * reference.norm()) << to_string(law);
    }
  }
}

}  // namespace
}  // namespace brainshift::test
