#pragma once

#include <string>
#include <vector>

namespace groundloop::slam {

/// What a recorded sequence does not say of the head that made it.
struct SourceOptions {
  double camera_height_m = 0.35;  ///< of the left camera above the floor; it is taken to look level and ahead
  /// The images are raw, and these files (one or two, slam/rectify/stereo_calibration.h) hold the calibration,
  /// in place of what the layout itself has. Empty: as the layout says.
  std::vector<std::string> calibration_files = {};
};

}  // namespace groundloop::slam
