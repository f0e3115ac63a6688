#pragma once

namespace groundloop::slam {

/// What a recorded sequence does not say of the head that made it.
struct SourceOptions {
  double camera_height_m = 0.35;  ///< of the left camera above the floor; it is taken to look level and ahead
};

}  // namespace groundloop::slam
