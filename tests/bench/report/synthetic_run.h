#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "bench/report/footprint.h"
#include "slam/types/frame_result.h"
#include "slam/types/occupancy_map.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::bench {

/// A run whose every answer is known: the camera drives 1.2 laps of a circle of 2.5 m about (6, 4) in a room
/// of 12 m x 8 m with two desks; the estimate is the truth moved up by a known error.
struct SyntheticRun {
  static constexpr int kFrames = 300;
  static constexpr double kRadius_m = 2.5;
  static constexpr double kError_m = 0.25;  ///< constant position error of the estimate, upwards
  static constexpr int kLostFrom = 100;     ///< frames [100, 105) are lost
  static constexpr int kLostTo = 105;

  static slam::Pose T_world_map();
  static slam::Pose T_world_left(int frame);
  static slam::Pose T_map_left(int frame);
  static int64_t stamp_ns(int frame) { return 133'333'333LL * frame; }
  static std::vector<Footprint> outline();
  static bool is_occupied(const Eigen::Vector2d& p_world);
  /// The room on a grid of the world frame; cells outside the walls are free.
  static slam::OccupancyMap exact_map();
  /// What an ideal mapper would have made of it: on a grid of the map frame, unknown outside the walls.
  static slam::OccupancyMap estimated_map();
  static slam::StereoRig rig();
  /// A grey image, features of three kinds and the features of five frames before.
  static cv::Mat left_image();
  static std::vector<slam::FeatureObservation> features();
  static std::vector<std::vector<slam::FeatureObservation>> history();
  /// Half-resolution disparity of a sloping wall; the left quarter is unknown.
  static cv::Mat disparity();

  /// Writes the whole folder.
  static void write(const std::string& dir);
  /// Adds two right links and a wrong one, and the trajectory without them, 0.4 m to the side.
  static void add_links(const std::string& dir);
  /// Adds a study with one row beside the run as it is.
  static void add_oracles(const std::string& dir);
};

/// The run.json of the synthetic run, for tests that change it.
std::string synthetic_run_json(const std::string& result, const std::string& name = "synthetic_circle");

void write_text(const std::string& file, const std::string& text);

}  // namespace groundloop::bench
