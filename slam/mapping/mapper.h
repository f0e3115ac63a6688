#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "slam/mapping/flog_grid.h"
#include "slam/mapping/flog_options.h"
#include "slam/mapping/local_map.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// What a key frame saw of one point, kept so that a map can be built again at corrected poses.
struct MapObservation {
  Eigen::Vector3f uvu_px = Eigen::Vector3f::Zero();  ///< (u_left, v, u_right)
  float weight = 1;                                  ///< trust in [0, 1]
};

/// Builds the global map from key frames: each one's points make a local map, which is then added to the
/// global one. Section 2.4 of the paper.
class Mapper {
 public:
  Mapper(const StereoRig& rig, const FlogOptions& options);

  void add(const Pose& T_map_left, std::span<const MapObservation> observations);
  const FlogGrid& grid() const { return grid_; }

 private:
  StereoRig rig_;
  FlogOptions options_;
  LocalMap local_;
  FlogGrid grid_;
  std::vector<MapPoint> points_;
};

}  // namespace groundloop::slam
