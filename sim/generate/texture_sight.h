#pragma once

#include <vector>

#include "sim/head/head.h"
#include "sim/truth/truth_world.h"
#include "sim/world/mjcf.h"
#include "sim/world/world.h"

namespace groundloop::sim {

/// Contrast of pictures [grey levels]: mean standard deviation within patches of 16 x 16 pixels. Every file is
/// read once.
class PictureContrast {
 public:
  double of_file(const std::string& file);

 private:
  std::map<std::string, double> known_;
};

/// How much of what a camera sees can be tracked: rays through a raster of the image, of which those count that meet
/// a contrasty picture neither too near nor too far.
class TextureSight {
 public:
  /// @param mjcf  the same world with its textures, which `world` may lack
  TextureSight(const World& world, const MjcfElement& mjcf, const TruthWorld& truth, const HeadModel& head,
               PictureContrast& pictures);

  /// Part of the left image, 0 to 1, that shows texture from a body pose on the floor.
  double visible(double x_m, double y_m, double yaw_rad) const;

 private:
  const TruthWorld& truth_;
  slam::StereoRig rig_;
  std::vector<char> contrasty_;  ///< by geom
};

}  // namespace groundloop::sim
