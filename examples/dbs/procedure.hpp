// The stages of the procedure. The library knows none of them: each is a change of settings or
// devices and one solve.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "electrode.hpp"
#include "head.hpp"
#include "measure.hpp"
#include "options.hpp"
#include "scene.hpp"

namespace dbs {

enum class Action {
  none,
  turn_head,   // from the posture of the image to that of surgery
  lose_fluid,
  insert_cannula,
  insert_lead,
  test,
  remove_cannula,
  restore      // fluid, and the posture of the image
};

struct Stage {
  std::string label;   // 0, 1, ... 6a, 6b, 6c, ... 9
  std::string title;
  Action action;
  int side;
};

// Told how far a procedure is. The procedure itself prints nothing.
class Watcher {
 public:
  virtual ~Watcher() = default;
  virtual void stage_begins(const std::vector<Stage>& plan, std::size_t stage) = 0;
  virtual bool goes_on(const Progress& solve) = 0;   // after every iteration; false ends the solve
  virtual void stage_ends() = 0;                     // in balance
};

// Drives a Stepper through the stages.
class Procedure {
 public:
  // Throws brainshift::Error for what cannot be, before anything is solved. The watcher, if any, must
  // outlive the procedure.
  Procedure(const Head& head, const Options& options, Watcher* watcher = nullptr);

  Stepper& stepper() { return m_stepper; }
  const Stepper& stepper() const { return m_stepper; }
  // Displacement since stage 0 (N x 3, mm): stage 0 of a load-free image moves too.
  Points shift() const { return m_stepper.displacement() - m_tissue.reference(); }
  const BeamDevice& device_model(int side) const {
    return m_stepper.device_model(m_side[side].device);
  }
  const SceneIds& ids() const { return m_ids; }
  const Vec3& gravity() const { return m_gravity; }

  const std::vector<Stage>& plan() const { return m_plan; }   // stages that will be done
  // Applies the changes of a stage and solves; throws brainshift::Error for what cannot be. After
  // Status::cancelled the results are of no stage.
  StageResult run(const Stage& stage);

  // Where the procedure is, to go on from again: a branch.
  struct Branch;
  std::shared_ptr<const Branch> branch() const;
  void go_back_to(const std::shared_ptr<const Branch>& branch);
  // Other electrodes and another order of sides, in the stages still to come (`options` as those of
  // before, but for them). Throws brainshift::Error for what cannot be, nothing changed.
  void replan(const Options& options);

 private:
  struct Operated {   // what has been done on a side
    std::optional<Goal> goal;               // with or without devices
    std::optional<Trajectory> trajectory;   // towards it
    std::optional<Electrode> electrode;
    Vec3 goal_at_rest;                        // the tissue of the goal, in the mesh as given
    double lost_before = 0.0;                 // mm^3 of fluid at stage 0, against the mesh as given
    DeviceId device = -1;
    bool in_cannula = false;
    Points track;                             // where its material was when it was made
    std::optional<TipMark> released, closed;  // when the cannula left; at the end of surgery
  };

  static Stepper make_stepper(const Head& head, const Options& options, Watcher* watcher, SceneIds& ids);
  std::vector<Stage> make_plan() const;
  void check_losses() const;
  void plan_sides();
  bool ends_surgery(const Stage& stage) const;   // fluid comes back next
  bool is_operated(int side) const { return m_side[side].trajectory.has_value(); }
  void check_plan();   // every stage's settings, before the first is solved
  void apply(const Stage& stage);
  void set_loads(const Stage& stage);   // fluid and gravity
  SolveReport solve();   // to rest: as one balance, or step by step
  void lose(int side, const Loss& loss, double part);
  void insert_cannula(int side);
  void insert_lead(int side);
  void remove_cannula(int side);
  void mark(const Stage& stage);
  Vec3 tissue_at(const Vec3& point) const;
  Vec3 place_of_goal(int side) const;
  LeadResult measure_lead(int side) const;
  std::string remark_on(const StageResult& result) const;

  const Head& m_head;
  Options m_options;
  Watcher* m_watcher;   // may be null
  Loss m_loss[2];
  Vec3 m_gravity;
  SceneIds m_ids;
  Stepper m_stepper;
  TissueMeasures m_tissue;
  double m_full_level;
  std::array<Operated, 2> m_side;
  std::vector<Stage> m_plan;
};

struct Procedure::Branch {
  std::shared_ptr<const Stepper::Snapshot> state;
  std::array<Operated, 2> side;
  Options options;
  std::vector<Stage> plan;
};

}  // namespace dbs
