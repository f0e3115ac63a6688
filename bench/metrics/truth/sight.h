#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/truth/truth_world.h"
#include "slam/types/pose.h"
#include "slam/types/stereo_rig.h"

namespace groundloop::bench {

/// What the two cameras of a rig truly see of a scene that stands still. All members may be used by several
/// threads.
class Sight {
 public:
  /// @param scene  must outlive this object
  Sight(const sim::TruthWorld& scene, const slam::StereoRig& rig) : scene_(scene), rig_(rig) {}

  /// Surface point [world] under a pixel of the left image; none where the ray meets nothing within 100 m.
  std::optional<Eigen::Vector3d> surface(const slam::Pose& T_world_left,
                                         const Eigen::Vector2d& uv_left_px) const;

  /// Pixel of the left, or right, image that shows a surface point; none when the point is behind the camera,
  /// outside the image or hidden by something more than 5 mm nearer.
  std::optional<Eigen::Vector2d> left_px(const slam::Pose& T_world_left,
                                         const Eigen::Vector3d& p_world) const;
  std::optional<Eigen::Vector2d> right_px(const slam::Pose& T_world_left,
                                          const Eigen::Vector3d& p_world) const;

  /// Surface points under the centres of 16 x 12 equal tiles of the left image; fewer where rays meet
  /// nothing.
  std::vector<Eigen::Vector3d> view(const slam::Pose& T_world_left) const;

  /// Part of the points of a view that the left camera of another pose sees, in [0, 1]; 0 of an empty view.
  /// @param enough  the answer is exact only when it is at least this, else anything below it: most pairs of
  ///                frames share nothing, and are found out cheaply
  double share_seen(const std::vector<Eigen::Vector3d>& view_world, const slam::Pose& T_world_left,
                    double enough = 0) const;

 private:
  bool hidden(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& p_world) const;

  const sim::TruthWorld& scene_;
  slam::StereoRig rig_;
};

}  // namespace groundloop::bench
