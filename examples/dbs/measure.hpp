// What is measured after a stage.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "head.hpp"
#include "trajectory.hpp"

namespace dbs {

// Motion of the tip along the trajectory, positive towards the burr hole (mm): in the frame of the
// skull, and beside the tissue that was at the tip at the start (NaN: the tip was not in tissue).
struct Retraction {
  double skull, tissue;
};

struct LeadResult {
  DeviceState state;
  Trajectory trajectory;        // as it was inserted
  Vec3 off_target;              // mm; of the planned contact from the tissue of the target
  bool in_cannula;
  Vec3 track_motion;            // mm, mean over the track since it was made
  double largest_track_motion;  // mm, across the trajectory
  std::optional<Retraction> since_cannula_left, since_surgery;
};

struct StageResult {
  std::string label;               // of the procedure: 0, 1, ... 6a, 6b, 6c, ... 9
  std::string title;
  double time;                     // place in the series
  SolveReport report;
  CompartmentState fluid[2];       // by Side
  double tissue_loss;              // mm^3: volume of the brain at stage 0 minus now
  double surface_motion[2];        // mm; largest of the side's outer surface
  double midline_shift;            // mm, positive to the right; mean of the nodes facing the falx
  std::map<std::string, Vec3> shifts;   // mm, of the landmarks
  std::map<std::string, double> errors;   // mm, of the mesh in their shifts; empty unless asked for
  std::optional<LeadResult> lead[2];    // by Side
  std::string remark;              // a sentence; empty: none
};   // all motions count from stage 0

// Measures tissue and fluid of a head from its rest state.
class TissueMeasures {
 public:
  TissueMeasures(const Head& head, const Stepper& stepper);
  void set_reference(const Stepper& stepper);   // stage 0
  const Points& reference() const { return m_before; }   // displacement at stage 0
  void fill(const Stepper& stepper, StageResult& result) const;
  void estimate_errors(const Stepper& stepper, StageResult& result) const;

 private:
  void prepare_landmarks();

  const Head& m_head;
  Points m_before;
  double m_volume_before;
  Indices m_outer[2];
  std::vector<std::string> m_names;
  Points m_landmarks_before;   // their displacement at stage 0
  Points m_landmarks;   // moved onto the nearest node where outside the mesh
};

// Where a tip was, and the tissue that was there.
class TipMark {
 public:
  TipMark(const Stepper& stepper, const Vec3& tip);
  Retraction since(const Stepper& stepper, const Vec3& tip, const Vec3& outward) const;

 private:
  Vec3 m_tip;
  PointValues m_rest;   // of the tissue at the tip, in the mesh as given
};

}  // namespace dbs
