#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace groundloop::sim {

/// Corners of a pixel's footprint in a rendered image, in order around it; the centre of the image's first
/// pixel is (0, 0). Convex.
using Footprint = std::array<Eigen::Vector2d, 4>;

/// A sparse table that resamples an image once: every output pixel is the mean of the image over its
/// footprint, each input pixel weighted by the exact area of its part inside (rounded to 2^-14 of the
/// whole, so that an even image stays even).
class AreaTable {
 public:
  explicit AreaTable(cv::Size input) : input_(input) {}

  /// Appends the next output pixel.
  /// @param channel  that is read when the input has several
  /// @throws std::invalid_argument when the footprint reaches beyond the input or has no area
  void add(const Footprint& footprint, int channel);

  /// @param image   CV_8UC1 or CV_8UC3 of the input's size, continuous
  /// @param factor  by which output pixel i is multiplied, one for each
  /// @param output  CV_32FC1 with as many pixels as were added; filled row by row
  void apply(const cv::Mat& image, const std::vector<float>& factor, cv::Mat& output) const;

 private:
  static constexpr int kWidth = 4;
  static constexpr int kOne = 1 << 14;
  /// A short run of input pixels.
  struct Tap {
    int32_t first;
    std::array<int16_t, kWidth> weight;
  };
  template <int kChannels>
  void apply_channels(const uchar* input, const std::vector<float>& factor, float* output) const;
  void round_weights(size_t first_tap, const std::vector<double>& areas);

  cv::Size input_;
  std::vector<Tap> taps_;
  std::vector<uint32_t> end_;  ///< by output pixel: one past its last tap
  std::vector<uint8_t> channel_;
  std::vector<double> areas_;  ///< of the footprint in work, by tap and place
};

}  // namespace groundloop::sim
