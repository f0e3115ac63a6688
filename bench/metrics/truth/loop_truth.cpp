#include "bench/metrics/truth/loop_truth.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace groundloop::bench {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

/// For each key frame the first later one that does not see its place any more, or the number of key frames.
/// Never sooner than that of the key frame before: places go out of sight in the order they were come to.
std::vector<size_t> first_away(const Sight& sight, const std::vector<TrueView>& key_frames,
                               const std::vector<std::vector<Eigen::Vector3d>>& views) {
  std::vector<size_t> away(key_frames.size());
  size_t next = 0;
  for (size_t i = 0; i < key_frames.size(); ++i) {
    next = std::max(next, i + 1);
    while (next < key_frames.size() &&
           sight.share_seen(views[next], key_frames[i].T_world_left, kOutOfSight) >= kOutOfSight) {
      ++next;
    }
    away[i] = next;
  }
  return away;
}

}  // namespace

bool near_and_alike(const slam::Pose& T_world_a, const slam::Pose& T_world_b) {
  const slam::Pose T_a_b = T_world_a.inverse() * T_world_b;
  return T_a_b.translation().norm() <= kRevisitDistance_m &&
         kDegPerRad * slam::rotation_angle_rad(T_a_b.linear()) <= kRevisitAngle_deg;
}

std::optional<double> same_place(const Sight& sight, const slam::Pose& T_world_earlier,
                                 const slam::Pose& T_world_later,
                                 const std::vector<Eigen::Vector3d>& later_view) {
  if (!near_and_alike(T_world_earlier, T_world_later)) return std::nullopt;
  const double overlap = sight.share_seen(later_view, T_world_earlier, kRevisitOverlap);
  if (overlap < kRevisitOverlap) return std::nullopt;
  return overlap;
}

std::vector<Revisit> true_revisits(const Sight& sight, const std::vector<TrueView>& key_frames) {
  std::vector<std::vector<Eigen::Vector3d>> views;
  views.reserve(key_frames.size());
  for (const TrueView& k : key_frames) views.push_back(sight.view(k.T_world_left));
  const std::vector<size_t> away = first_away(sight, key_frames, views);

  std::vector<Revisit> revisits;
  std::vector<std::pair<double, size_t>> candidates;  // distance, earlier key frame
  for (size_t later = 0; later < key_frames.size(); ++later) {
    const slam::Pose& T_world_later = key_frames[later].T_world_left;
    candidates.clear();
    for (size_t earlier = 0; earlier < later && away[earlier] < later; ++earlier) {
      const slam::Pose& T_world_earlier = key_frames[earlier].T_world_left;
      const double distance_m = (T_world_earlier.translation() - T_world_later.translation()).norm();
      if (near_and_alike(T_world_earlier, T_world_later)) candidates.emplace_back(distance_m, earlier);
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [distance_m, earlier] : candidates) {
      const auto overlap = same_place(sight, key_frames[earlier].T_world_left, T_world_later, views[later]);
      if (!overlap) continue;
      revisits.push_back({earlier, later, *overlap});
      break;
    }
  }
  return revisits;
}

JudgedLink judge_link(const Sight& sight, const slam::LoopLink& link, const slam::Pose& T_world_from,
                      const slam::Pose& T_world_to) {
  const slam::Pose T_from_to = T_world_from.inverse() * T_world_to;
  const slam::Pose error = T_from_to.inverse() * link.T_from_to;
  JudgedLink judged{link, sight.share_seen(sight.view(T_world_to), T_world_from), error.translation().norm(),
                    kDegPerRad * slam::rotation_angle_rad(error.linear()), false};
  const bool seen = link.kind == slam::LinkKind::kMap || judged.overlap >= kOutOfSight;
  judged.right = seen && judged.error_m <= kRightLink_m && judged.error_deg <= kRightLink_deg;
  return judged;
}

LoopScore score_loops(const std::vector<TrueView>& key_frames, std::vector<Revisit> revisits,
                      std::vector<JudgedLink> links) {
  std::vector<bool> linked(key_frames.size(), false);
  for (const JudgedLink& judged : links) {
    if (!judged.right) continue;
    const auto owner = std::lower_bound(key_frames.begin(), key_frames.end(), judged.link.to_index,
                                        [](const TrueView& k, int64_t frame) { return k.frame < frame; });
    if (owner != key_frames.end()) linked[static_cast<size_t>(owner - key_frames.begin())] = true;
  }
  LoopScore score{std::move(links), std::move(revisits), 0};
  for (const Revisit& revisit : score.revisits) score.found += linked[revisit.later] ? 1 : 0;
  return score;
}

Metrics LoopScore::metrics() const {
  Metrics metrics;
  if (!links.empty()) {
    const auto right = std::count_if(links.begin(), links.end(), [](const JudgedLink& l) { return l.right; });
    metrics["loop.precision"] = static_cast<double>(right) / static_cast<double>(links.size());
  }
  if (!revisits.empty()) {
    metrics["loop.recall"] = static_cast<double>(found) / static_cast<double>(revisits.size());
  }
  return metrics;
}

}  // namespace groundloop::bench
