#pragma once

#include <vector>

#include "bench/report/footprint.h"
#include "sim/truth/truth_world.h"
#include "sim/world/scene_motion.h"
#include "sim/world/world.h"

namespace groundloop::bench {

/// What of the scene an exact map is made of.
struct MapBand {
  double min_m;    ///< heights: above the floor ..
  double max_m;    ///< .. up to 2 m as the paper's
  double sight_m;  ///< how far a cell may be to count as seen
};

/// Of a room, times the size of the scenario's scene relative to a room.
MapBand map_band(const sim::Scenario& scenario);

/// The exact scene, standing as in the world's file, without people.
sim::TruthWorld exact_scene(const sim::World& world);

/// The exact scene as it is at any time of a scenario.
class SceneInTime {
 public:
  /// Everything as at time 0. Both must outlive this object.
  SceneInTime(const sim::World& world, const sim::Scenario& scenario);

  /// Puts people and furniture where they are at a time. True when furniture stands elsewhere than before.
  bool move_to(double time_s);
  /// What is seen: with people.
  const sim::TruthWorld& seen() const { return seen_; }
  /// What a map should hold: without people, furniture where it stands now.
  const sim::TruthWorld& standing() const { return standing_; }
  const MapBand& band() const { return band_; }
  /// Whether a robot drives; else an arm carries the camera, and its plan answers for what it touches.
  bool driven() const { return driven_; }

 private:
  const MapBand band_;
  const bool driven_;
  sim::SceneMotion motion_;
  sim::World::DataPtr state_;
  sim::TruthWorld seen_, standing_;
};

/// Outlines of everything that reaches into the band.
std::vector<Footprint> scene_outline(const sim::TruthWorld& world, const MapBand& band);

}  // namespace groundloop::bench
