#include "bench/metrics/pose_error.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "bench/metrics/path.h"

namespace groundloop::bench {
namespace {

using IndexPairs = std::vector<std::pair<size_t, size_t>>;

constexpr double kDegPerRad = 180 / std::numbers::pi;

double reduced(const slam::Pose& E, PoseRelation relation) {
  switch (relation) {
    case PoseRelation::kTranslationPart:
    case PoseRelation::kPointDistance:
      return E.translation().norm();
    case PoseRelation::kRotationPart:
      return (E.linear() - Eigen::Matrix3d::Identity()).norm();
    case PoseRelation::kFull:
      return (E.matrix() - Eigen::Matrix4d::Identity()).norm();
    case PoseRelation::kAngleDeg:
      return slam::rotation_angle_rad(E.linear()) * kDegPerRad;
    case PoseRelation::kAngleRad:
      return slam::rotation_angle_rad(E.linear());
  }
  return 0;
}

double angle_between_rad(const slam::Pose& a, const slam::Pose& b) {
  return slam::rotation_angle_rad(a.linear().transpose() * b.linear());
}

IndexPairs by_frames(size_t poses, size_t delta, bool all_pairs) {
  IndexPairs pairs;
  for (size_t i = 0; i + delta < poses; i += all_pairs ? 1 : delta) pairs.emplace_back(i, i + delta);
  return pairs;
}

IndexPairs by_path_consecutive(const slam::Trajectory& poses, double delta_m) {
  // The first sub-trajectory starts where delta has been travelled for the first time, as in evo.
  std::vector<size_t> ends;
  double travelled_m = 0;
  for (size_t i = 1; i < poses.size(); ++i) {
    travelled_m += (poses[i].T.translation() - poses[i - 1].T.translation()).norm();
    if (travelled_m < delta_m) continue;
    ends.push_back(i);
    travelled_m = 0;
  }
  IndexPairs pairs;
  for (size_t i = 1; i < ends.size(); ++i) pairs.emplace_back(ends[i - 1], ends[i]);
  return pairs;
}

IndexPairs by_path_all(const slam::Trajectory& poses, double delta_m, double tolerance_m) {
  const std::vector<double> travelled_m = travelled(poses);
  IndexPairs pairs;
  size_t j = 1;
  for (size_t i = 0; i + 1 < poses.size(); ++i) {
    const auto off_m = [&](size_t to) { return std::abs(travelled_m[to] - travelled_m[i] - delta_m); };
    // The nearest end moves only forward with the start, and the path only grows: walk while it gets nearer,
    // over runs of equal poses too, then back to the first of those as near.
    j = std::max(j, i + 1);
    size_t best = j;
    for (size_t k = j + 1; k < poses.size() && off_m(k) <= off_m(best); ++k) best = k;
    j = best;
    while (best > i + 1 && off_m(best - 1) <= off_m(best)) --best;
    if (off_m(best) <= tolerance_m) pairs.emplace_back(i, best);
  }
  return pairs;
}

IndexPairs by_angle_consecutive(const slam::Trajectory& poses, double delta_rad) {
  IndexPairs pairs;
  size_t start = 0;
  double turned_rad = 0;
  for (size_t i = 1; i < poses.size(); ++i) {
    turned_rad += angle_between_rad(poses[i - 1].T, poses[i].T);
    if (turned_rad < delta_rad) continue;
    pairs.emplace_back(start, i);
    start = i;
    turned_rad = 0;
  }
  return pairs;
}

IndexPairs by_angle_all(const slam::Trajectory& poses, double delta_rad, double tolerance_rad) {
  IndexPairs pairs;
  for (size_t i = 0; i < poses.size(); ++i) {
    for (size_t j = i + 1; j < poses.size(); ++j) {
      const double angle_rad = angle_between_rad(poses[i].T, poses[j].T);
      if (angle_rad >= delta_rad - tolerance_rad && angle_rad <= delta_rad + tolerance_rad) {
        pairs.emplace_back(i, j);
      }
    }
  }
  return pairs;
}

}  // namespace

const char* unit_of(PoseRelation relation) {
  switch (relation) {
    case PoseRelation::kTranslationPart:
    case PoseRelation::kPointDistance:
      return "m";
    case PoseRelation::kAngleDeg:
      return "deg";
    case PoseRelation::kAngleRad:
      return "rad";
    default:
      return "";
  }
}

std::vector<double> absolute_errors(const PosePairs& pairs, PoseRelation relation) {
  const bool of_points =
      relation == PoseRelation::kTranslationPart || relation == PoseRelation::kPointDistance;
  std::vector<double> errors;
  errors.reserve(pairs.size());
  for (size_t i = 0; i < pairs.size(); ++i) {
    const slam::Pose& truth = pairs.truth[i].T;
    const slam::Pose& estimate = pairs.estimate[i].T;
    errors.push_back(of_points ? (estimate.translation() - truth.translation()).norm()
                               : reduced(estimate.inverse() * truth, relation));
  }
  return errors;
}

std::vector<std::pair<size_t, size_t>> sub_trajectories(const slam::Trajectory& poses,
                                                        const RelativeOptions& options) {
  if (!(options.delta > 0)) throw std::invalid_argument("delta must be positive");
  const double tolerance = options.delta * options.relative_tolerance;
  switch (options.unit) {
    case DeltaUnit::kFrames:
      if (options.delta < 1) throw std::invalid_argument("delta must be at least 1 frame");
      return by_frames(poses.size(), static_cast<size_t>(options.delta), options.all_pairs);
    case DeltaUnit::kMetres:
      return options.all_pairs ? by_path_all(poses, options.delta, tolerance)
                               : by_path_consecutive(poses, options.delta);
    case DeltaUnit::kDegrees:
      return options.all_pairs ? by_angle_all(poses, options.delta / kDegPerRad, tolerance / kDegPerRad)
                               : by_angle_consecutive(poses, options.delta / kDegPerRad);
    case DeltaUnit::kRadians:
      return options.all_pairs ? by_angle_all(poses, options.delta, tolerance)
                               : by_angle_consecutive(poses, options.delta);
  }
  return {};
}

std::vector<double> relative_errors(const PosePairs& pairs, const RelativeOptions& options) {
  std::vector<double> errors;
  for (const auto& [i, j] :
       sub_trajectories(options.pairs_from_reference ? pairs.truth : pairs.estimate, options)) {
    const slam::Pose& truth_i = pairs.truth[i].T;
    const slam::Pose& truth_j = pairs.truth[j].T;
    const slam::Pose& estimate_i = pairs.estimate[i].T;
    const slam::Pose& estimate_j = pairs.estimate[j].T;
    if (options.relation == PoseRelation::kPointDistance) {
      errors.push_back(std::abs((truth_i.translation() - truth_j.translation()).norm() -
                                (estimate_i.translation() - estimate_j.translation()).norm()));
    } else {
      errors.push_back(reduced((truth_i.inverse() * truth_j).inverse() * (estimate_i.inverse() * estimate_j),
                               options.relation));
    }
  }
  return errors;
}

}  // namespace groundloop::bench
