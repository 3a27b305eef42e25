// Displacement gradients that the material tests share.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "support/laws.hpp"

namespace brainshift::test {

struct Sample {
  std::string name;
  Mat3 G;
};

inline Mat3 random_matrix(std::mt19937& generator) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Mat3 m;
  for (int i = 0; i < 9; ++i) m.data()[i] = uniform(generator);
  return m;
}

inline Mat3 random_rotation(std::mt19937& generator) {
  std::uniform_real_distribution<double> angle(-3.0, 3.0);
  const Vec3 axis = random_matrix(generator).col(0).normalized();
  return Eigen::AngleAxisd(angle(generator), axis).toRotationMatrix();
}

// F - I with the given singular values, signs included, in random frames.
inline Mat3 with_stretches(const Vec3& s, std::mt19937& generator) {
  const Mat3 U = random_rotation(generator), V = random_rotation(generator);
  return U * s.asDiagonal() * V.transpose() - Mat3::Identity();
}

inline std::vector<Sample> samples() {
  std::mt19937 generator(1);
  std::vector<Sample> all;
  all.push_back({"rest", Mat3::Zero()});
  for (int i = 0; i < 5; ++i) {
    all.push_back({"small", 1e-4 * random_matrix(generator)});
    all.push_back({"moderate", 0.2 * random_matrix(generator)});
    all.push_back({"large, turned", with_stretches({1.8, 0.9, 0.5}, generator)});
    all.push_back({"equal stretches", with_stretches({0.7, 0.7, 0.7}, generator)});
    all.push_back({"needle", with_stretches({30.0, 0.8, 0.7}, generator)});
    all.push_back({"nearly flat", with_stretches({1.2, 0.9, 1e-3}, generator)});
    all.push_back({"flat", with_stretches({1.2, 0.9, 0.0}, generator)});
    all.push_back({"inverted", with_stretches({1.3, 0.9, -0.4}, generator)});
    all.push_back({"line", with_stretches({1.3, 0.6, 0.01}, generator)});
  }
  return all;
}

// Those at which the law has an energy.
inline std::vector<Sample> samples(Law law) {
  std::vector<Sample> all = samples();
  if (allows_inversion(law)) return all;
  const auto turned = [](const Sample& s) { return s.name == "flat" || s.name == "inverted"; };
  all.erase(std::remove_if(all.begin(), all.end(), turned), all.end());
  return all;
}

}  // namespace brainshift::test
