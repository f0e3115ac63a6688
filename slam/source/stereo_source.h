#pragma once

#include <cstdint>
#include <optional>

#include "slam/types/stereo_frame.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// Where stereo pairs come from: a recorded sequence, a live head or the simulator. Everything after this
/// interface is the same code.
class StereoSource {
 public:
  virtual ~StereoSource() = default;
  virtual const StereoRig& rig() const = 0;
  /// The next pair, or none at the end.
  virtual std::optional<StereoFrame> next() = 0;
  /// Number of pairs when it is known beforehand.
  virtual std::optional<int64_t> size() const { return std::nullopt; }
};

}  // namespace groundloop::slam
