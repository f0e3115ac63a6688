#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "slam/types/config.h"

namespace groundloop::slam {

class OnTimeView;

/// Options of the dense disparity map. YAML: slam.disparity
struct DisparityOptions {
  int max_disparity_px = 128;   ///< search width at full resolution
  int window_px = 11;           ///< correlation window at half resolution, odd
  int uniqueness_percent = 10;  ///< by how much the best match must beat the second best
  int texture_threshold = 10;   ///< least texture of a window

  template <class Archive>
  void visit(Archive& a) {
    a("max_disparity_px", max_disparity_px, {.min = 32, .max = 512});
    a("window_px", window_px, {.min = 5, .max = 51});
    a("uniqueness_percent", uniqueness_percent, {.min = 0, .max = 100});
    a("texture_threshold", texture_threshold, {.min = 0, .max = 1000});
  }
  void check(ConfigReader& reader) const {
    if (max_disparity_px % 32 != 0) reader.problem("max_disparity_px", "a multiple of 32");
    if (window_px % 2 == 0) reader.problem("window_px", "an odd number");
  }
};

/// Disparity [full-resolution px] of a half-resolution map (DenseDisparity::half_resolution) near a
/// full-resolution pixel: the median of the known values around it.
std::optional<float> disparity_around(const cv::Mat& half_resolution, float u_px, float v_px);

/// Known disparities of a half-resolution map on a grid, away from the jumps of depth: appends
/// (u_left, v, u_right) [full-resolution px].
/// @param turn  which of the grids of this step, each shifted against the others: any number, successive ones
/// go round
void sample_disparity(const cv::Mat& half_resolution, int step_px, int64_t turn,
                      std::vector<Eigen::Vector3f>& uvu_px);

/// Dense disparity by block matching on half-resolution images: rough, and cheap. Section 2.2 of the paper.
class DenseDisparity {
 public:
  explicit DenseDisparity(const DisparityOptions& options);

  /// @param left,right rectified, CV_8UC1
  /// @param view  of a late right image; the map is then that of a pair taken together
  void compute(const cv::Mat& left, const cv::Mat& right, const OnTimeView* view = nullptr);

  /// Half-resolution map, CV_16SC1: disparity in half-resolution px times 16; negative where unknown.
  const cv::Mat& half_resolution() const { return disparity_; }

  /// disparity_around() of this map.
  std::optional<float> around(float u_px, float v_px) const {
    return disparity_around(disparity_, u_px, v_px);
  }

 private:
  void forget_matches_outside();
  void bring_in_time(const OnTimeView& view);

  cv::Ptr<cv::StereoBM> matcher_;
  cv::Mat half_left_, half_right_, half_view_, wide_left_, wide_right_, wide_disparity_, disparity_;
};

}  // namespace groundloop::slam
