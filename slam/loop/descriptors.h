#pragma once

#include <cstdint>
#include <opencv2/features2d.hpp>
#include <vector>

#include "slam/loop/stored_view.h"

namespace groundloop::slam {

/// Describes the corners of an image: ORB over an image pyramid, spread over the image, each with the depth
/// that the dense disparity knows there.
class Describer {
 public:
  /// @param keypoints  wanted at most
  explicit Describer(int keypoints);

  /// @param grey            left image, CV_8UC1
  /// @param half_disparity  DenseDisparity::half_resolution() of the same pair
  /// @param found           overwritten; corners without known depth are left out
  void describe(const cv::Mat& grey, const cv::Mat& half_disparity, std::vector<Keypoint>& found);

 private:
  int wanted_;
  cv::Ptr<cv::ORB> orb_;
  std::vector<cv::KeyPoint> corners_;
  cv::Mat half_, bits_;
};

/// Number of bits in which two descriptors differ.
int distance(const Descriptor& a, const Descriptor& b);

/// Distances of one descriptor to many: distances[i] = distance(a, others[i]).
void distances(const Descriptor& a, const Descriptor* others, int count, int* result);

/// A pair of descriptors, by their indices.
struct DescriptorMatch {
  int a = 0, b = 0;
};

/// Pairs that are each other's nearest and clearly nearer than the second nearest (Lowe's ratio test).
/// @param max_distance  bits
/// @param ratio         nearest / second nearest, at most
void match_descriptors(const std::vector<Keypoint>& a, const std::vector<Keypoint>& b, int max_distance,
                       double ratio, std::vector<DescriptorMatch>& matches);

}  // namespace groundloop::slam
