#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "slam/features/corner_response.h"
#include "slam/types/config.h"

namespace groundloop::slam {

/// Options of the Shi-Tomasi detector. YAML: slam.detection
struct DetectionOptions {
  double min_distance_px = 14;  ///< between features
  double quality = 0.005;       ///< least response, relative to the strongest of the image
  double min_response = 2e-5;   ///< least response, absolute; what noise makes beyond it is refused later

  template <class Archive>
  void visit(Archive& a) {
    a("min_distance_px", min_distance_px, {.min = 2, .max = 200});
    a("quality", quality, {.min = 0, .max = 1});
    a("min_response", min_response, {.min = 0, .max = 1});
  }
};

/// Shi-Tomasi corners: local maxima of the smaller eigenvalue of the gradient matrix, strongest first, spread
/// over the image by a least distance to each other and to the features that are there already. Section 2.1
/// of the paper.
class Detector {
 public:
  explicit Detector(const DetectionOptions& options) : options_(options) {}

  /// @param grey      CV_8UC1
  /// @param occupied  features to keep away from [px]
  /// @param border_px no feature nearer to the image border
  /// @return at most `wanted` corners at whole pixels; valid until the next call
  const std::vector<Eigen::Vector2f>& detect(const cv::Mat& grey,
                                             const std::vector<Eigen::Vector2f>& occupied, int wanted,
                                             int border_px);

 private:
  struct Candidate {
    float response;
    int u, v;
  };
  DetectionOptions options_;
  CornerResponse response_;
  std::vector<uint8_t> marks_;
  std::vector<Candidate> candidates_;
  std::vector<Eigen::Vector2f> corners_;
};

}  // namespace groundloop::slam
