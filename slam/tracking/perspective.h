#pragma once

#include <Eigen/Core>

#include "slam/tracking/feature.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::slam {

/// How the surface around a feature leans, from its shapes in both images of its first view: relative change
/// of 1 / depth [1 / px of the left image]. A plane's disparity is linear in the image, and what the right
/// window lacks in width, or leans, is the change of disparity.
/// @param disparity_px  beyond the disparity at infinity, positive
Eigen::Vector2f inverse_depth_slope(const AffineState& left, const AffineState& right, double disparity_px);

/// Perspective c of a small plane, first seen where its feature was and now from another place: a point at x
/// px from the feature in the first view lies at A x / (1 + c x) px from it now. The ratio of the depths in
/// the two views is linear in x, as 1 / depth is in the first. The same in the left and the right image.
/// @param T_left_first  left camera of the first view in the present one
/// @param p_left  the feature [m], in front of both cameras
/// @return c [1 / px]
Eigen::Vector2f perspective_per_px(const StereoRig& rig, const Pose& T_left_first,
                                   const Eigen::Vector3d& p_left, const Eigen::Vector2f& slope_per_px);

}  // namespace groundloop::slam
