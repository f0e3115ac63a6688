#include "slam/loop/loop_detector.h"

#include <algorithm>
#include <cmath>

#include "slam/types/counter_random.h"

namespace groundloop::slam {
namespace {

constexpr double kLeastOverlap = 0.2;  // of a view's landmarks, for a closer look
constexpr double kOutOfSight = 0.1;    // less of them: the camera looks elsewhere
constexpr double kSamePlace = 0.2;     // views that overlap so much are one place
constexpr double kRivalScore = 0.5;    // a rival looks at least so much alike, relative to the best
constexpr int kLandmarksAsked = 32;

/// a then b: T_a_c = T_a_b T_b_c, to first order.
PosePrediction compose(const PosePrediction& a, const PosePrediction& b) {
  const Pose T_c_b = b.T_from_to.inverse();
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = T_c_b.linear();
  adjoint.topRightCorner<3, 3>() = skew(T_c_b.translation()) * T_c_b.linear();
  return {a.T_from_to * b.T_from_to, adjoint * a.covariance * adjoint.transpose() + b.covariance};
}

PosePrediction measured(const LoopLink& link) { return {link.T_from_to, link.covariance}; }

}  // namespace

LoopDetector::LoopDetector(const StereoRig& rig, const LoopOptions& options, const KltOptions& klt,
                           const StereoOptions& stereo, const RegistrationOptions& registration,
                           uint64_t seed)
    : rig_(rig),
      options_(options),
      pyramid_levels_(klt.levels),
      seed_(seed),
      describer_(options.descriptors),
      verifier_(rig, options, klt, stereo, registration) {}

LoopAnswer LoopDetector::process(const LoopKeyFrame& key_frame, const RelativePose& relative_pose) {
  current_.view.index = key_frame.index;
  in_sight_since_ = key_frame.in_sight_since;
  current_.view.grey = key_frame.left;
  current_.view.landmarks = key_frame.landmarks;
  current_.right_lag = key_frame.right_lag;
  current_.half_disparity = key_frame.half_disparity;
  current_.left.build(key_frame.left, pyramid_levels_);
  current_.right.build(key_frame.right, pyramid_levels_);
  describer_.describe(key_frame.left, key_frame.half_disparity, current_.view.keypoints);

  LoopAnswer answer;
  bool covered = false;
  recognise(relative_pose, answer, covered);
  if (!covered && static_cast<int>(views_.size()) < options_.max_views) {
    index_.add(current_.view.keypoints);
    views_.push_back(std::move(current_.view));
    answer.stored = true;
  }
  return answer;
}

void LoopDetector::recognise(const RelativePose& relative_pose, LoopAnswer& answer, bool& covered) {
  choose_candidates(relative_pose);
  if (candidates_.empty()) answer.message = "no stored view looks alike";
  std::optional<Accepted> best;
  for (const Candidate& candidate : candidates_) {
    const uint64_t seed =
        random_bits(seed_, static_cast<uint64_t>(current_.view.index), static_cast<uint64_t>(candidate.view));
    const Verification found =
        verifier_.verify(views_[static_cast<size_t>(candidate.view)], current_, candidate.prediction, seed);
    if (!found.accepted) {
      if (answer.message.empty()) answer.message = found.message;
      continue;
    }
    const bool predicted = candidate.prediction.has_value();
    if (!predicted && best && !agree(best->link, found.link, relative_pose)) {
      answer.message = "two places look the same";
      return;
    }
    if (!best || found.link.inliers > best->link.inliers) best = {found.link, found.inlier_ratio, predicted};
    if (predicted && found.inlier_ratio >= options_.covered_ratio) break;
  }
  if (!best) return;
  answer.message.clear();
  covered = best->inlier_ratio >= options_.covered_ratio;
  if (best->predicted || confirmed(best->link, relative_pose)) {
    answer.link = best->link;
  } else {
    answer.message = "waits for the next key frame to agree";
  }
}

/// The stored views worth a closer look, best first: those that look alike, and those that should be in sight
/// where the pose is known well.
void LoopDetector::choose_candidates(const RelativePose& relative_pose) {
  candidates_.clear();
  const auto views = static_cast<int>(views_.size());
  bool all_expected = true;
  for (int view = 0; view < views; ++view) {
    StoredView& stored = views_[static_cast<size_t>(view)];
    const auto prediction = relative_pose(stored.index, current_.view.index);
    const double overlap = prediction ? predicted_overlap(stored, prediction->T_from_to) : 0;
    if (prediction && overlap < kOutOfSight) stored.was_away = true;
    // What the tracker has just seen is no news, unless it has lost its way since.
    const bool young =
        stored.index > std::min(current_.view.index - options_.min_age_frames, in_sight_since_);
    if (prediction && young) continue;
    const bool expected = prediction && verifier_.precise_enough(stored, *prediction);
    if (expected && overlap < kLeastOverlap) continue;
    all_expected = all_expected && expected;
    candidates_.push_back({view, expected ? 2 * overlap : 0, prediction});
  }
  if (!all_expected) add_likeness();
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  keep_the_best(relative_pose);
}

/// Looks count where it is not known what is in sight.
void LoopDetector::add_likeness() {
  const auto views = static_cast<int>(views_.size());
  index_.query(current_.view.keypoints, views, views, alike_);
  std::vector<double> alike(views_.size(), 0);
  for (const PlaceCandidate& candidate : alike_)
    alike[static_cast<size_t>(candidate.view)] = candidate.score / alike_.front().score;
  for (Candidate& candidate : candidates_) candidate.score += alike[static_cast<size_t>(candidate.view)];
  std::erase_if(candidates_, [](const Candidate& candidate) { return !(candidate.score > 0); });
}

/// The best candidates; where nothing is predicted also the best of another place, as a rival.
void LoopDetector::keep_the_best(const RelativePose& relative_pose) {
  const auto wanted = static_cast<size_t>(options_.candidates);
  if (candidates_.size() <= wanted) return;
  const Candidate first = candidates_.front();
  auto rival = candidates_.end();
  if (!first.prediction) {
    const auto other_place = [&](const Candidate& candidate) {
      const StoredView& stored = views_[static_cast<size_t>(candidate.view)];
      const auto between = relative_pose(views_[static_cast<size_t>(first.view)].index, stored.index);
      return !between ||
             predicted_overlap(views_[static_cast<size_t>(first.view)], between->T_from_to) < kSamePlace;
    };
    rival = std::find_if(candidates_.begin() + static_cast<std::ptrdiff_t>(wanted), candidates_.end(),
                         other_place);
  }
  if (rival != candidates_.end() && rival->score > kRivalScore * first.score) {
    std::swap(candidates_[wanted], *rival);
    candidates_.resize(wanted + 1);
  } else {
    candidates_.resize(wanted);
  }
}

/// Share of a view's landmarks that are in sight at a similar distance.
double LoopDetector::predicted_overlap(const StoredView& stored, const Pose& T_from_to) const {
  if (stored.landmarks.empty()) return 0;
  const Pose T_to_from = T_from_to.inverse();
  const size_t stride = std::max<size_t>(1, stored.landmarks.size() / kLandmarksAsked);
  int asked = 0, seen = 0;
  for (size_t i = 0; i < stored.landmarks.size(); i += stride) {
    ++asked;
    const Landmark& landmark = stored.landmarks[i];
    const Eigen::Vector3d p_to = T_to_from * point_of(rig_, landmark);
    const double growth = landmark.depth_m / p_to.z();
    if (!(growth > 0.5 && growth < 2)) continue;
    const Eigen::Vector3d uvu = rig_.project(p_to);
    if (uvu.x() >= 0 && uvu.x() < rig_.width_px && uvu.y() >= 0 && uvu.y() < rig_.height_px) ++seen;
  }
  return static_cast<double>(seen) / asked;
}

/// Whether two links put the current frame in the same place.
bool LoopDetector::agree(const LoopLink& a, const LoopLink& b, const RelativePose& relative_pose) const {
  const auto between = relative_pose(a.from_index, b.from_index);
  if (!between) return false;
  PosePrediction there = compose(*between, measured(b));
  if (a.to_index != b.to_index) {
    const auto moved = relative_pose(b.to_index, a.to_index);
    if (!moved) return false;
    there = compose(there, *moved);
  }
  return contradiction_sigma(there, measured(a), options_) <= options_.gate_sigma;
}

/// Whether enough successive key frames agree with a link that nothing predicted.
bool LoopDetector::confirmed(const LoopLink& link, const RelativePose& relative_pose) {
  const int agreeing = pending_ && agree(link, pending_->link, relative_pose) ? pending_->agreeing + 1 : 1;
  pending_ = Pending{link, agreeing};
  return agreeing >= options_.confirmations;
}

size_t LoopDetector::bytes() const {
  size_t sum = 0;
  for (const StoredView& view : views_) sum += view.bytes();
  return sum;
}

}  // namespace groundloop::slam
