#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "slam/types/config.h"
#include "slam/types/pose.h"

namespace groundloop::slam {

/// The stages whose work a bench can do in the core's place, to measure what part of the error each one
/// makes.
enum class OracleStage {
  kTracking,  ///< where a feature is in a new pair
  kStereo,    ///< where a pixel of the left image is in the right one
  kMotion,    ///< registration
  kLoops      ///< recognition of places, and the poses measured there
};

/// Where a surface point is in a pair.
struct TrueMatch {
  Eigen::Vector2d left_px = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector2d> right_px;  ///< none: hidden in the right image, or outside of it
};

/// Exact answers in the place of single stages. The core does not know who gives them; without an oracle,
/// which is the rule, every stage does its own work. It is an experiment, not an option: no preset and no
/// configuration file asks for one, and a run that had one says so.
///
/// Frames are named by StereoFrame::index and must have been delivered. None means that there is no answer
/// (the point is hidden or out of view, the ray meets nothing, the frames do not see the same place): the
/// stage then has no result there, as when it fails; it does not fall back on its own work. Members may be
/// called by several threads.
class Oracle {
 public:
  virtual ~Oracle() = default;

  /// Whether this stage is to be replaced; of the others nothing may be asked.
  virtual bool replaces(OracleStage stage) const = 0;

  /// kTracking: where the surface point seen at `uv_first_px` of the left image of frame `first` is in the
  /// pair of `frame`; none when the left image does not show it.
  virtual std::optional<TrueMatch> track(int64_t first, const Eigen::Vector2d& uv_first_px,
                                         int64_t frame) const = 0;

  /// kStereo: u_left - u_right [px] of the surface at a pixel of the left image (sub-pixel position); none
  /// when the right image does not show it.
  virtual std::optional<double> disparity_px(int64_t frame, const Eigen::Vector2d& uv_left_px) const = 0;

  /// kMotion: pose of the left camera of frame `to` in that of frame `from`.
  virtual std::optional<Pose> T_from_to(int64_t from, int64_t to) const = 0;

  /// kLoops: the same, but only where the two frames see the same place, so that they could have been
  /// recognised.
  virtual std::optional<Pose> loop_T_from_to(int64_t from, int64_t to) const = 0;
};

}  // namespace groundloop::slam

namespace groundloop {
template <>
struct EnumNames<slam::OracleStage> {
  static constexpr std::array<std::pair<slam::OracleStage, const char*>, 4> names = {
      {{slam::OracleStage::kTracking, "tracking"},
       {slam::OracleStage::kStereo, "stereo"},
       {slam::OracleStage::kMotion, "motion"},
       {slam::OracleStage::kLoops, "loops"}}};
};
}  // namespace groundloop
