#pragma once

#include <Eigen/Core>
#include <optional>

#include "bench/metrics/association.h"
#include "slam/types/config.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

/// p_truth = scale * R * p_map + t, with R and t in T_truth_map.
struct Alignment {
  double scale = 1;
  slam::Pose T_truth_map = slam::Pose::Identity();
  bool unique = true;  ///< false when the points lie on a line (or are one), so that a rotation is left open
};

/// Rigid or similarity motion that best lays the estimated points on the true ones:
///   minimises  sum_i | p_truth_i - (scale R p_map_i + t) |^2
/// @param p_truth, p_map  3 x N [m], column i of both at the same time, N >= 1
/// @param with_scale      false fixes the scale at 1
/// @see Umeyama, PAMI 13(4) 1991, Eq. (38)-(43)
Alignment align_points(const Eigen::Matrix3Xd& p_truth, const Eigen::Matrix3Xd& p_map, bool with_scale);

/// How an estimate is laid on the truth before errors are taken.
enum class AlignMode {
  kNone,
  kSe3,    ///< rotation and translation
  kSim3,   ///< rotation, translation and scale
  kScale,  ///< the scale of the similarity alone
  kOrigin  ///< the first pose laid on the first true pose
};

/// Aligns the estimate in place.
/// @param first_poses  align by so many poses from the beginning; none: by all
/// @return what was applied
Alignment align(PosePairs& pairs, AlignMode mode, std::optional<size_t> first_poses = std::nullopt);

/// How the estimate's map lies in the world: as align() with kSe3 says, but of a path along a line, whose
/// positions leave a rotation open, the orientations decide.
slam::Pose map_placement(const PosePairs& pairs);

/// Positions of the poses, 3 x N [m].
Eigen::Matrix3Xd positions_of(const slam::Trajectory& poses);

}  // namespace groundloop::bench

namespace groundloop {
template <>
struct EnumNames<bench::AlignMode> {
  static constexpr std::array<std::pair<bench::AlignMode, const char*>, 5> names = {
      {{bench::AlignMode::kNone, "none"},
       {bench::AlignMode::kSe3, "se3"},
       {bench::AlignMode::kSim3, "sim3"},
       {bench::AlignMode::kScale, "scale"},
       {bench::AlignMode::kOrigin, "origin"}}};
};
}  // namespace groundloop
