#pragma once

#include <string>
#include <vector>

namespace groundloop::slam {

/// What a recorded sequence does not say of the head that made it.
struct SourceOptions {
  double camera_height_m = 0.35;  ///< of the left camera above the floor; it is taken to look level and ahead
  /// The file may list its pairs in any order of time (pairs picked from a longer recording, say); they are
  /// delivered in order of time. Otherwise a time that goes back is an error: nearly always a broken file.
  bool any_order = false;
  /// The images are raw, and these files (one or two, slam/rectify/stereo_calibration.h) hold the calibration,
  /// in place of what the layout itself has. Empty: as the layout says.
  std::vector<std::string> calibration_files = {};
};

}  // namespace groundloop::slam
