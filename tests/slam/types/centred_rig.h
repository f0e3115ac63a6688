#pragma once

#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// Rectified rig with square pixels and both principal points in the middle of the images; its body stands
/// where the left camera is.
inline StereoRig centred_rig(int width_px, int height_px, double focal_px, double baseline_m) {
  StereoRig rig;
  rig.width_px = width_px;
  rig.height_px = height_px;
  rig.fx_px = rig.fy_px = focal_px;
  rig.cx_px = rig.cx_right_px = (width_px - 1) / 2.0;
  rig.cy_px = (height_px - 1) / 2.0;
  rig.baseline_m = baseline_m;
  return rig;
}

}  // namespace groundloop::slam
