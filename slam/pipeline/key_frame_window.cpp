#include "slam/pipeline/key_frame_window.h"

#include <algorithm>
#include <tuple>

#include "slam/stereo/matcher.h"

namespace groundloop::slam {

void KeyFrameWindow::add(int key_frame, const Pose& T_odom_left,
                         const std::optional<Pose>& T_previous_planned,
                         const std::vector<Feature>& features) {
  KeyFrame entry{key_frame, T_odom_left, T_previous_planned, {}};
  entry.sights.reserve(features.size());
  for (const Feature& feature : features) {
    entry.sights.push_back({feature.id, optimal_measurement(feature.left.uv_px, feature.right.uv_px),
                            feature.cofactor, feature.p_kf});
  }
  key_frames_.push_back(std::move(entry));
  if (static_cast<int>(key_frames_.size()) > options_.key_frames) key_frames_.pop_front();
}

WindowProblem KeyFrameWindow::problem(const GroundPlane& plane) const {
  WindowProblem window;
  AdjustmentProblem& problem = window.problem;
  problem.plane = plane;
  struct Entry {
    int64_t feature_id;
    int key_frame;
    const Sight* sight;
  };
  std::vector<Entry> entries;
  for (size_t k = 0; k < key_frames_.size(); ++k) {
    const KeyFrame& key_frame = key_frames_[k];
    window.key_frames.push_back(key_frame.number);
    problem.key_frames.push_back({key_frame.T_odom_left, k == 0});
    for (const Sight& sight : key_frame.sights) {
      entries.push_back({sight.feature_id, static_cast<int>(k), &sight});
    }
    if (k > 0 && options_.plan_sigma_ratio > 0 && key_frame.T_previous_planned) {
      const Pose& T_from_to = *key_frame.T_previous_planned;
      problem.motions.push_back({static_cast<int>(k) - 1, static_cast<int>(k), T_from_to,
                                 planned_motion_covariance(T_from_to, options_.plan_sigma_ratio)});
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.feature_id, a.key_frame) < std::tie(b.feature_id, b.key_frame);
  });
  for (size_t first = 0; first < entries.size();) {
    size_t end = first + 1;
    while (end < entries.size() && entries[end].feature_id == entries[first].feature_id) ++end;
    if (end - first >= 2) {
      const Entry& newest = entries[end - 1];
      const int landmark = static_cast<int>(window.feature_ids.size());
      window.feature_ids.push_back(newest.feature_id);
      problem.landmarks_odom.push_back(problem.key_frames[newest.key_frame].T_odom_left *
                                       newest.sight->p_left);
      for (size_t i = first; i < end; ++i) {
        problem.observations.push_back({entries[i].key_frame, landmark, entries[i].sight->uvu_px,
                                        options_.sigma_px, entries[i].sight->cofactor});
      }
    }
    first = end;
  }
  return window;
}

void KeyFrameWindow::refine(const std::vector<int>& key_frames, const std::vector<Pose>& T_odom_left) {
  for (KeyFrame& entry : key_frames_) {
    const auto found = std::lower_bound(key_frames.begin(), key_frames.end(), entry.number);
    if (found == key_frames.end() || *found != entry.number) continue;
    entry.T_odom_left = T_odom_left[static_cast<size_t>(found - key_frames.begin())];
  }
}

}  // namespace groundloop::slam
