#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bench/metrics/metrics.h"
#include "bench/metrics/truth/sight.h"
#include "slam/types/loop_link.h"
#include "slam/types/pose.h"

namespace groundloop::bench {

/// A key frame and where its left camera truly was.
struct TrueView {
  int64_t frame = 0;
  slam::Pose T_world_left = slam::Pose::Identity();
};

/// Two key frames of which the later truly sees the place of the earlier again.
struct Revisit {
  size_t earlier = 0;  ///< indices into the list of key frames
  size_t later = 0;
  double overlap = 0;  ///< part of what the later one sees that the earlier one saw
};

/// Overlap from which a key frame sees a place again, and the nearness that makes it the same view of it:
/// from farther off, or another side, the same surfaces look different.
inline constexpr double kRevisitOverlap = 0.5;
inline constexpr double kRevisitDistance_m = 2.0;
inline constexpr double kRevisitAngle_deg = 45;
/// Below this overlap a place is out of sight; a link between such frames recognised nothing.
inline constexpr double kOutOfSight = 0.1;

/// Whether two poses are within kRevisitDistance_m and kRevisitAngle_deg of each other.
bool near_and_alike(const slam::Pose& T_world_a, const slam::Pose& T_world_b);

/// Whether `later` sees the place of `earlier`: near, turned alike, overlap of kRevisitOverlap.
/// @param later_view  Sight::view() of the later pose
/// @return the overlap, none when they do not
std::optional<double> same_place(const Sight& sight, const slam::Pose& T_world_earlier,
                                 const slam::Pose& T_world_later,
                                 const std::vector<Eigen::Vector3d>& later_view);

/// For every key frame that truly comes back to a place, the nearest earlier key frame that saw it;
/// neighbours along the path are none: between the two there is a key frame that did not see the place
/// (overlap below kOutOfSight). Turning once on the spot is coming back; standing still is not.
/// @param key_frames  in the order of time
std::vector<Revisit> true_revisits(const Sight& sight, const std::vector<TrueView>& key_frames);

/// A link beside the truth.
struct JudgedLink {
  slam::LoopLink link;
  double overlap = 0;  ///< part of what frame `to` sees that frame `from` saw
  double error_m = 0;  ///< of the measured pose
  double error_deg = 0;
  bool right = false;
};

inline constexpr double kRightLink_m = 0.1;
inline constexpr double kRightLink_deg = 2.0;

/// A link is right when its pose is within kRightLink_m and kRightLink_deg of the true one and, for
/// landmarks, its frames share at least kOutOfSight of what they see (a map may be matched where no image
/// overlaps).
JudgedLink judge_link(const Sight& sight, const slam::LoopLink& link, const slam::Pose& T_world_from,
                      const slam::Pose& T_world_to);

/// How well places were recognised over a run.
struct LoopScore {
  std::vector<JudgedLink> links;
  std::vector<Revisit> revisits;
  size_t found = 0;  ///< revisits whose later key frame got a right link

  /// loop.precision, loop.recall; absent without links, without revisits
  Metrics metrics() const;
};

/// @param links       judged; a link belongs to the first key frame at or after its frame `to`
/// @param key_frames  that the revisits speak of
LoopScore score_loops(const std::vector<TrueView>& key_frames, std::vector<Revisit> revisits,
                      std::vector<JudgedLink> links);

}  // namespace groundloop::bench
