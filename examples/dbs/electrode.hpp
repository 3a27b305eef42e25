// The devices of one side: what is put in at each stage and how it is held.
#pragma once

#include "options.hpp"
#include "trajectory.hpp"

namespace dbs {

// Cannula, lead and wire on one trajectory. The library sees one device per track: the cannula, then
// the lead inside it (held where the cannula is), then the lead alone.
class Electrode {
 public:
  Electrode(const Options& options, const Trajectory& trajectory);

  const Trajectory& trajectory() const { return m_trajectory; }
  // Where the device that goes in first has its tip: the cannula.
  Placement cannula_placement() const;
  BeamDevice cannula() const;
  Hold cannula_hold() const;
  TrackOptions track() const;

  // Lead (or test electrode) through the cannula down to the target.
  BeamDevice lead_in_cannula(const std::string& name) const;
  Hold hold_in_cannula() const;
  // The lead alone, its wire fixed at the burr hole.
  BeamDevice lead() const;
  Hold hold_of_wire() const;

  double cannula_depth() const { return m_options.cannula_depth; }

 private:
  BeamDevice bare_lead(const std::string& name) const;

  Options m_options;
  Trajectory m_trajectory;
};

}  // namespace dbs
