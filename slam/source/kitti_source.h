#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "slam/rectify/rectifier.h"
#include "slam/source/source_options.h"
#include "slam/source/stereo_source.h"

namespace groundloop::slam {

/// A recorded sequence in the layout of the KITTI odometry benchmark: DIR/image_0 and image_1 (rectified PNG,
/// NNNNNN.png, in order of their names), times.txt (seconds, one a pair, each once),
/// calib.txt (3x4 projections P0 and P1). With SourceOptions::calibration_files the images are raw, and there
/// need be no calib.txt. Pairs are delivered in order of time, whatever the file's order is:
/// some sequences are picked from a longer recording.
class KittiSource : public StereoSource {
 public:
  /// Reads the calibration, the times and the names of the images; the images themselves when asked for.
  /// @throws InputError naming every file that is missing or wrong, with line and value
  explicit KittiSource(const std::string& directory, const SourceOptions& options = {});

  const StereoRig& rig() const override { return rig_; }
  /// @throws InputError when an image cannot be read or has another size than the first
  std::optional<StereoFrame> next() override;
  std::optional<int64_t> size() const override { return static_cast<int64_t>(stamps_ns_.size()); }
  /// Whether times.txt lists its pairs in another order than that of time.
  bool out_of_order() const { return out_of_order_; }
  /// Times of exposure of all pairs, in order.
  const std::vector<int64_t>& stamps_ns() const { return stamps_ns_; }

 private:
  StereoRig rig_;
  std::vector<int64_t> stamps_ns_;
  std::vector<std::string> left_files_, right_files_;
  bool out_of_order_ = false;
  std::optional<Rectifier> rectifier_;  ///< of raw images
  int64_t next_ = 0;
};

}  // namespace groundloop::slam
