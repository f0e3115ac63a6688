#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "bench/report/footprint.h"
#include "slam/types/frame_result.h"
#include "slam/types/occupancy_map.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::bench {

// Pictures of a run, after the figures of the paper. All are BGR, CV_8UC3, and the same input gives the same
// bytes.

/// Left image with the tracked features (paper Fig. 1 and 7). Small images are enlarged to about 1280 px.
/// New features, inliers and outliers differ in colour and in mark; a thin tail shows where the feature was
/// in the frames before, a tick to the left a quarter of its disparity.
///
/// @param left      8-bit grey
/// @param features  of this frame
/// @param history   features of the frames before, oldest first; may be empty (about 8 frames look well)
cv::Mat draw_tracked(const cv::Mat& left, const std::vector<slam::FeatureObservation>& features,
                     const std::vector<std::vector<slam::FeatureObservation>>& history = {});

/// Dense disparity in false colours (paper Fig. 2), with a bar labelled in full-resolution px and in metres.
/// @param disparity  CV_16SC1 at half resolution: half-resolution px * 16; negative: unknown (drawn dark)
/// @param rig        of the full-resolution pair
cv::Mat draw_disparity(const cv::Mat& disparity, const slam::StereoRig& rig);

/// One point of a cloud, ready to draw or as read from cloud.ply.
struct DrawnPoint {
  Eigen::Vector3f p = Eigen::Vector3f::Zero();  ///< [m], z up
  float sigma_m = 0;                            ///< standard deviation along its ray; larger is drawn fainter
};

/// A recognised place: from where it was seen first to where it was seen again.
struct DrawnLink {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< left camera [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  bool wrong = false;  ///< by the truth
};

/// What a top view shows. Everything is in one frame with z up: the world of a simulated run, the map of a
/// replay.
struct TopView {
  slam::Trajectory truth;          ///< left camera; may be empty
  slam::Trajectory estimate;       ///< left camera
  slam::Trajectory without_links;  ///< the estimate had no place been recognised; may be empty
  std::vector<DrawnLink> links;
  std::vector<slam::Pose> key_frames;  ///< left camera; a dot for position and a segment for heading each
  std::vector<DrawnPoint> cloud;
  std::vector<Footprint> outline;
};

/// Estimated and true trajectory, links between places, key frames and cloud over the scene, from above
/// (paper Fig. 3 and 8), 1600 px wide.
cv::Mat draw_top_view(const TopView& view);

/// The values of `map` on a grid of another frame: each cell takes the value at its centre, unknown outside.
/// @param T_world_map  how the map lies in the grid's frame; only its planar part matters
slam::OccupancyMap resampled_map(const slam::OccupancyMap& map, const slam::Pose& T_world_map,
                                 const slam::GridGeometry& geometry);

/// The estimated map beside the exact one on the same scale (paper Fig. 4 and 9), 1600 px wide. Cells between
/// the thresholds are grey, a little paler or darker as they lean.
/// @param estimate  in the world frame (resampled_map)
/// @param exact     none: the estimated map alone
/// @param visible   of the exact map's cells, those that the true trajectory could see; empty: all. Others
/// are pale
cv::Mat draw_map_pair(const slam::OccupancyMap& estimate, const std::optional<slam::OccupancyMap>& exact,
                      const std::vector<uint8_t>& visible = {});

/// Where the two maps differ on the visible cells: right, false occupied, false free, missed, not seen; areas
/// in m^2.
/// @throws std::invalid_argument when geometries or sizes differ
cv::Mat draw_map_difference(const slam::OccupancyMap& estimate, const slam::OccupancyMap& exact,
                            const std::vector<uint8_t>& visible);

}  // namespace groundloop::bench
