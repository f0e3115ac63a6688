#include "bench/runner/truth_oracle.h"

#include <utility>

#include "bench/metrics/truth/loop_truth.h"

namespace groundloop::bench {

using Eigen::Vector2d;

TruthOracle::TruthOracle(std::set<slam::OracleStage> stages, const sim::TruthWorld& scene,
                         const slam::StereoRig& rig, TruePoses T_world_left)
    : stages_(std::move(stages)), sight_(scene, rig), T_world_left_(std::move(T_world_left)) {}

std::optional<slam::TrueMatch> TruthOracle::track(int64_t first, const Vector2d& uv_first_px,
                                                  int64_t frame) const {
  const auto p_world = sight_.surface(T_world_left_(first), uv_first_px);
  if (!p_world) return std::nullopt;
  const slam::Pose T_world_left = T_world_left_(frame);
  const auto left_px = sight_.left_px(T_world_left, *p_world);
  if (!left_px) return std::nullopt;
  return slam::TrueMatch{*left_px, sight_.right_px(T_world_left, *p_world)};
}

std::optional<double> TruthOracle::disparity_px(int64_t frame, const Vector2d& uv_left_px) const {
  const slam::Pose T_world_left = T_world_left_(frame);
  const auto p_world = sight_.surface(T_world_left, uv_left_px);
  if (!p_world) return std::nullopt;
  const auto right_px = sight_.right_px(T_world_left, *p_world);
  if (!right_px) return std::nullopt;
  return uv_left_px.x() - right_px->x();
}

std::optional<slam::Pose> TruthOracle::T_from_to(int64_t from, int64_t to) const {
  return T_world_left_(from).inverse() * T_world_left_(to);
}

std::optional<slam::Pose> TruthOracle::loop_T_from_to(int64_t from, int64_t to) const {
  const slam::Pose T_world_from = T_world_left_(from), T_world_to = T_world_left_(to);
  if (!near_and_alike(T_world_from, T_world_to)) return std::nullopt;
  if (!same_place(sight_, T_world_from, T_world_to, sight_.view(T_world_to))) return std::nullopt;
  return T_world_from.inverse() * T_world_to;
}

}  // namespace groundloop::bench
