#pragma once

#include <cstdint>
#include <vector>

#include "bench/runner/exact_scene.h"
#include "slam/types/occupancy_map.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::bench {

/// Exact map, and what the true trajectory could see of it (sim::TruthWorld::visible_cells).
struct ExactMap {
  slam::OccupancyMap map;
  std::vector<uint8_t> sight;
};

/// Gathers what the true trajectory could see while the run goes on.
class ExactMapper {
 public:
  /// @param scene  must outlive the mapper
  ExactMapper(const SceneInTime& scene, const slam::StereoRig& rig, double cell_m);

  /// Furniture was moved: a cell that has changed counts from when it is seen again.
  void look_again();

  /// Looks about from every fifth frame; takes the frames in order, the scene as it is in each.
  void look(int64_t frame, const slam::Pose& T_world_left);

  const ExactMap& exact() const { return exact_; }

 private:
  const SceneInTime& scene_;
  slam::StereoRig rig_;
  ExactMap exact_;
};

}  // namespace groundloop::bench
