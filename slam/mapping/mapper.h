#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "slam/mapping/flog_grid.h"
#include "slam/mapping/flog_options.h"
#include "slam/mapping/local_map.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// What a key frame saw of one point, kept so that a map can be built again at corrected poses: eight bytes,
/// since there are thousands of them in a key frame. A map is always built from these, also the first time,
/// so that building it again gives the same.
class MapObservation {
 public:
  MapObservation() = default;
  /// @param uvu_px    (u_left, v, u_right); positions 0 to 2047 px, disparities to +-511 px, else the nearest
  /// @param weight    trust in [0, 1]
  /// @param sigma_px  standard deviation of u_left - u_right, to 2 px; 0: that of the mapping options
  MapObservation(const Eigen::Vector3f& uvu_px, float weight, float sigma_px = 0);

  Eigen::Vector3d uvu_px() const {
    const double u_left_px = u_left_ / kPositionUnits;
    return {u_left_px, v_ / kPositionUnits, u_left_px - disparity_ / kDisparityUnits};
  }
  double weight() const { return weight_ / kWeightUnits; }
  double sigma_px() const { return sigma_ / kSigmaUnits; }

 private:
  /// Steps in a pixel, or in 1.
  static constexpr double kPositionUnits = 32, kDisparityUnits = 64, kSigmaUnits = 128, kWeightUnits = 255;

  uint16_t u_left_ = 0, v_ = 0;
  int16_t disparity_ = 0;
  uint8_t weight_ = 0, sigma_ = 0;
};
static_assert(sizeof(MapObservation) == 8);

/// What one key frame saw: written once, then shared by all that draw it.
using SharedObservations = std::shared_ptr<const std::vector<MapObservation>>;

/// A key frame's observations, and from where they were made.
struct PosedObservations {
  Pose T_map_left;
  SharedObservations observations;
};

/// Builds the global map from key frames: each one's points make a local map, which is then added to the
/// global one. Section 2.4 of the paper.
class Mapper {
 public:
  Mapper(const StereoRig& rig, const FlogOptions& options);

  void add(const Pose& T_map_left, std::span<const MapObservation> observations);
  /// Adds key frames in their order. A second thread draws every other local map: the grid is the same.
  void add_by_two(std::span<const PosedObservations> key_frames);
  const FlogGrid& grid() const { return grid_; }

 private:
  /// Where the local map of one key frame is drawn.
  struct Sheet {
    LocalMap local;
    std::vector<MapPoint> points;
  };
  void draw(const Pose& T_map_left, std::span<const MapObservation> observations, Sheet& sheet) const;

  StereoRig rig_;
  FlogOptions options_;
  Sheet sheet_;
  FlogGrid grid_;
};

}  // namespace groundloop::slam
