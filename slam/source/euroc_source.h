#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "slam/rectify/rectifier.h"
#include "slam/source/source_options.h"
#include "slam/source/stereo_source.h"

namespace groundloop::slam {

/// A recorded sequence in the ASL layout of the EuRoC data sets: DIR/mav0/cam0 and cam1, each with
/// sensor.yaml (T_BS, intrinsics, radial-tangential distortion, resolution), data.csv (stamp in ns, file
/// name) and data/. Images are rectified here. Pairs are the stamps that both cameras have.
class EurocSource : public StereoSource {
 public:
  /// @param directory  DIR, or DIR/mav0
  /// @throws InputError naming every file that is missing or wrong, with line and value
  explicit EurocSource(const std::string& directory, const SourceOptions& options = {});

  const StereoRig& rig() const override { return rig_; }
  /// @throws InputError when an image cannot be read or has not the size that sensor.yaml states
  std::optional<StereoFrame> next() override;
  std::optional<int64_t> size() const override { return static_cast<int64_t>(stamps_ns_.size()); }
  /// Times of exposure of all pairs.
  const std::vector<int64_t>& stamps_ns() const { return stamps_ns_; }

 private:
  StereoRig rig_;
  std::vector<int64_t> stamps_ns_;
  std::vector<std::string> left_files_, right_files_;
  std::optional<Rectifier> rectifier_;
  int64_t next_ = 0;
};

}  // namespace groundloop::slam
