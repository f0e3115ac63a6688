#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/metrics/association.h"
#include "slam/types/config.h"

namespace groundloop::bench {

/// Which number is made of the motion E between two poses that should be equal (names as evo's).
enum class PoseRelation {
  kTranslationPart,  ///< length of E's translation [m]
  kRotationPart,     ///< Frobenius norm of E's rotation matrix minus the identity
  kFull,             ///< Frobenius norm of E minus the identity
  kAngleDeg,         ///< rotation angle of E [deg]
  kAngleRad,         ///< rotation angle of E [rad]
  kPointDistance     ///< distance of the points [m]; relative: by how much the distances travelled differ
};

/// "m", "deg", "rad" or "" (no unit).
const char* unit_of(PoseRelation relation);

/// Absolute pose error: one number a pair of poses, E_i = T_estimate_i^-1 T_truth_i. Align beforehand.
std::vector<double> absolute_errors(const PosePairs& pairs, PoseRelation relation);

/// What a sub-trajectory's length is counted in.
enum class DeltaUnit { kFrames, kMetres, kDegrees, kRadians };

struct RelativeOptions {
  PoseRelation relation = PoseRelation::kTranslationPart;
  double delta = 1;  ///< length of the sub-trajectories, in `unit`; frames: rounded down, >= 1
  DeltaUnit unit = DeltaUnit::kFrames;
  bool all_pairs = false;             ///< a sub-trajectory from every pose, not one after the other
  bool pairs_from_reference = false;  ///< lengths are measured on the truth, not on the estimate
  double relative_tolerance = 0.1;    ///< all pairs: accepted deviation from delta, as a part of it
};

/// Index pairs (from, to) of the sub-trajectories of a given length.
///  frames:  i to i + delta
///  metres:  by path travelled. Consecutive ones end where delta is reached; of all pairs the nearest to
///  delta degrees, radians: consecutive ones by rotation accumulated from pose to pose; all pairs by direct
///  rotation
/// @throws std::invalid_argument when delta is not positive (frames: below 1)
std::vector<std::pair<size_t, size_t>> sub_trajectories(const slam::Trajectory& poses,
                                                        const RelativeOptions& options);

/// Relative pose error: one number a sub-trajectory (i, j),
///   E = (T_truth_i^-1 T_truth_j)^-1 (T_estimate_i^-1 T_estimate_j)
std::vector<double> relative_errors(const PosePairs& pairs, const RelativeOptions& options);

}  // namespace groundloop::bench

namespace groundloop {
template <>
struct EnumNames<bench::PoseRelation> {
  static constexpr std::array<std::pair<bench::PoseRelation, const char*>, 6> names = {
      {{bench::PoseRelation::kTranslationPart, "trans_part"},
       {bench::PoseRelation::kRotationPart, "rot_part"},
       {bench::PoseRelation::kFull, "full"},
       {bench::PoseRelation::kAngleDeg, "angle_deg"},
       {bench::PoseRelation::kAngleRad, "angle_rad"},
       {bench::PoseRelation::kPointDistance, "point_distance"}}};
};
template <>
struct EnumNames<bench::DeltaUnit> {
  static constexpr std::array<std::pair<bench::DeltaUnit, const char*>, 4> names = {
      {{bench::DeltaUnit::kFrames, "f"},
       {bench::DeltaUnit::kMetres, "m"},
       {bench::DeltaUnit::kDegrees, "d"},
       {bench::DeltaUnit::kRadians, "r"}}};
};
}  // namespace groundloop
