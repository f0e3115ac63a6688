#include "slam/tracking/tracker.h"

namespace groundloop::slam {
namespace {

constexpr double kMinDepth_m = 0.05;

Eigen::Vector2f left_of(const Eigen::Vector3d& uvu) { return uvu.head<2>().cast<float>(); }
Eigen::Vector2f right_of(const Eigen::Vector3d& uvu) {
  return Eigen::Vector2d(uvu.z(), uvu.y()).cast<float>();
}

}  // namespace

Tracker::Tracker(const StereoRig& rig, const TrackingOptions& options, const KltOptions& klt,
                 const StereoMatcher& matcher)
    : rig_(rig), options_(options), klt_(klt), matcher_(matcher) {}

void Tracker::track(const ImagePyramid& left, const ImagePyramid& right, const Pose& T_kf_previous,
                    const Pose& T_kf_left) {
  const Pose T_previous_kf = T_kf_previous.inverse(), T_left_kf = T_kf_left.inverse();
  for (Feature& feature : features_) {
    const Eigen::Vector3d p_previous = T_previous_kf * feature.p_kf;
    const Eigen::Vector3d p_left = T_left_kf * feature.p_kf;
    if (p_previous.z() < kMinDepth_m || p_left.z() < kMinDepth_m) {
      feature.in_left = feature.in_right = false;
      continue;
    }
    const Eigen::Vector3d now = rig_.project(p_left), before = rig_.project(p_previous);
    const auto growth = static_cast<float>(p_previous.z() / p_left.z());
    // From where it was found last, moved by the predicted displacement; a feature not found then starts from
    // its point alone.
    if (feature.in_left) {
      feature.left.uv_px += left_of(now) - left_of(before);
    } else {
      feature.left.uv_px = left_of(now);
    }
    if (feature.in_right) {
      feature.right.uv_px += right_of(now) - right_of(before);
    } else {
      feature.right.uv_px = right_of(now);
    }
    feature.left.A *= growth;
    feature.right.A *= growth;
    track_one(left, right, feature);
  }
}

void Tracker::track_again(const ImagePyramid& left, const ImagePyramid& right, const Pose& T_kf_left) {
  const Pose T_left_kf = T_kf_left.inverse();
  for (Feature& feature : features_) {
    if (feature.in_left && feature.in_right && feature.is_inlier) continue;
    const Eigen::Vector3d p_left = T_left_kf * feature.p_kf;
    if (p_left.z() < kMinDepth_m) continue;
    const Eigen::Vector3d now = rig_.project(p_left);
    feature.left.uv_px = left_of(now);
    feature.right.uv_px = right_of(now);
    track_one(left, right, feature);
  }
}

void Tracker::track_one(const ImagePyramid& left, const ImagePyramid& right, Feature& feature) const {
  const PatchTemplate& patch = first_view(feature);
  feature.in_right = false;
  feature.in_left = find(patch, left, feature.left);
  if (!feature.in_left) return;
  feature.in_right =
      find(patch, right, feature.right) && matcher_.plausible(feature.left.uv_px, feature.right.uv_px);
}

bool Tracker::find(const PatchTemplate& patch, const ImagePyramid& image, AffineState& state) const {
  const AffineState start = state;
  if (track_affine(patch, image, klt_, options_.start_level, state) == KltStatus::kTracked) return true;
  if (options_.start_level + 1 >= patch.levels) return false;
  state = start;
  return track_affine(patch, image, klt_, patch.levels - 1, state) == KltStatus::kTracked;
}

Feature* Tracker::add(const ImagePyramid& left, const Eigen::Vector2f& uv_px) {
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<int>(templates_.size()));
    templates_.push_back(std::make_unique<PatchTemplate>());
  }
  const int slot = free_slots_.back();
  if (!templates_[slot]->take(left, uv_px, klt_.levels)) return nullptr;
  free_slots_.pop_back();
  Feature feature;
  feature.id = next_id_++;
  feature.slot = slot;
  feature.left.uv_px = uv_px;
  feature.left.ncc = 1;
  feature.in_left = true;
  features_.push_back(feature);
  return &features_.back();
}

void Tracker::clear() {
  for (const Feature& feature : features_) free_slots_.push_back(feature.slot);
  features_.clear();
}

}  // namespace groundloop::slam
