// The stages of the procedure as far as tissue and fluid go, and what is measured after each.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "head.hpp"
#include "options.hpp"
#include "scene.hpp"

namespace dbs {

struct StageResult {
  int number;                      // of the procedure: 0, 1, 4, 6, 7, 9
  std::string title;
  SolveReport report;
  CompartmentState fluid[2];       // by Side
  double tissue_loss;              // mm^3: volume of the brain at stage 0 minus now
  double surface_motion[2];        // mm; largest of the side's outer surface
  double midline_shift;            // mm, positive to the right; mean of the nodes facing the falx
  std::map<std::string, Vec3> shifts;   // mm, of the landmarks
};   // all motions count from stage 0

// Drives a Stepper through the stages. The library knows none of them.
class Procedure {
 public:
  Procedure(const Head& head, const Options& options);

  Stepper& stepper() { return m_stepper; }
  const Stepper& stepper() const { return m_stepper; }
  // Displacement since stage 0 (N x 3, mm): stage 0 of a load-free image moves too.
  Points shift() const { return m_stepper.displacement() - m_before; }
  const SceneIds& ids() const { return m_ids; }
  const Vec3& gravity() const { return m_gravity; }

  // (number, title) of the stages that will be done.
  std::vector<std::pair<int, std::string>> plan() const;
  // Applies the changes of a stage and solves; throws brainshift::Error for settings that cannot be.
  StageResult run(int number, const std::string& title);

 private:
  static Stepper make_stepper(const Head& head, const Options& options, SceneIds& ids);
  void set_fluid(int number);
  void lose(int side, const Loss& loss, double part);
  void measure(StageResult& result) const;
  void prepare_landmarks();
  void check_plan();   // every stage's settings, before the first is solved

  const Head& m_head;
  Options m_options;
  Loss m_loss[2];
  Vec3 m_gravity;
  SceneIds m_ids;
  Stepper m_stepper;
  double m_full_level, m_volume_before;
  Points m_before;      // displacement at stage 0
  Indices m_outer[2], m_facing_falx;
  std::vector<std::string> m_names;
  Points m_landmarks;   // moved onto the nearest node where outside the mesh
};

}  // namespace dbs
