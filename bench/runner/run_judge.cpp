#include "bench/runner/run_judge.h"

#include <future>
#include <utility>

#include "bench/metrics/alignment.h"
#include "bench/metrics/correction.h"
#include "bench/metrics/trajectory_metrics.h"
#include "bench/metrics/truth/map_score.h"
#include "bench/metrics/uncertainty.h"
#include "slam/mapping/mapper.h"

namespace groundloop::bench {
namespace {

constexpr double kTouch_m = 0.01;  ///< distance that counts as touching: physics keeps solid things apart

/// The ceiling of the mapper: the same points at true poses, so that its errors and the localizer's separate.
/// Drawn beside the rest of the judgement; the core must outlive it.
std::future<slam::OccupancyMap> map_at_true_poses(const slam::Pipeline& core, const SimulatedSource& source) {
  std::vector<slam::PosedObservations> looks;
  for (const slam::KeyFrameRecord& k : core.key_frames()) {
    if (k.observations) looks.push_back({source.truth(k.index).T_world_left, k.observations});
  }
  return std::async(std::launch::async,
                    [rig = source.rig(), options = core.options().mapping, looks = std::move(looks)] {
                      slam::Mapper mapper(rig, options);
                      mapper.add_by_two(looks);
                      return mapper.grid().map();
                    });
}

slam::Trajectory left_truth(const SimulatedSource& source, size_t frames) {
  slam::Trajectory truth;
  truth.reserve(frames);
  for (size_t i = 0; i < frames; ++i) {
    const FrameTruth& t = source.truth(static_cast<int64_t>(i));
    truth.push_back({t.stamp_ns, t.T_world_left});
  }
  return truth;
}

}  // namespace

RunJudge::RunJudge(SceneInTime& scene, const SimulatedSource& source, const slam::Pipeline& core)
    : scene_(scene),
      source_(source),
      core_(core),
      sight_(scene.standing(), source.rig()),
      stages_(scene.seen(), source.rig()),
      exact_(scene, source.rig(), core.options().mapping.cell_m),
      looking_([this](const Seen& seen) { look(seen); }) {}

void RunJudge::observe(const slam::StereoFrame& frame, const slam::FrameResult& result) {
  const FrameTruth& truth = source_.truth(frame.index);
  recovery_.observe({result, frame.T_previous_left, truth.T_world_left}, [this] { return mapped_views(); });
  looking_.give({result, static_cast<double>(truth.seen_ns) * 1e-9, truth.T_world_seen, truth.T_world_body});
}

void RunJudge::look(const Seen& seen) {
  if (scene_.move_to(seen.time_s)) exact_.look_again();
  exact_.look(seen.result.index, seen.T_world_left);
  stage_errors_.push_back(stages_.judge(seen.result, seen.T_world_left));
  if (!scene_.driven()) return;
  const Eigen::Vector3d p_world = seen.T_world_body.translation();
  const double yaw_rad = slam::yaw_rad(seen.T_world_body.linear());
  collisions_ += scene_.standing().collision(p_world.x(), p_world.y(), yaw_rad, kTouch_m) ? 1 : 0;
}

RunJudgement RunJudge::judge(const std::vector<slam::FrameResult>& frames) {
  looking_.finish();
  std::future<slam::OccupancyMap> ceiling = map_at_true_poses(core_, source_);
  RunJudgement run;
  run.stages = std::move(stage_errors_);
  run.truth = left_truth(source_, frames.size());
  PosePairs pairs{run.truth, core_.trajectory()};
  run.metrics = trajectory_metrics(pairs);
  run.metrics.merge(tracking_metrics(frames));
  run.metrics.merge(recovery_.metrics());
  run.metrics.merge(stages_.total().metrics());
  run.metrics.merge(uncertainty());
  run.metrics.merge(drive());

  run.without_links = without_links(frames, core_.trajectory());
  run.metrics.merge(correction_metrics(run.truth, run.without_links, core_.trajectory()));
  LoopScore score = loops();
  run.metrics.merge(score.metrics());
  run.links = std::move(score.links);

  run.T_world_map = map_placement(pairs);
  align(pairs, AlignMode::kSe3);
  for (size_t i = 0; i < pairs.size(); ++i) {
    run.position_error_m.push_back(
        (pairs.truth[i].T.translation() - pairs.estimate[i].T.translation()).norm());
  }
  run.metrics.merge(map_metrics(run.T_world_map, ceiling.get()));
  return run;
}

Metrics RunJudge::map_metrics(const slam::Pose& T_world_map, const slam::OccupancyMap& at_true_poses) const {
  const ExactMap& exact = exact_.exact();
  Metrics metrics = bench::map_metrics(score_map(exact.map, exact.sight, core_.map(), T_world_map));
  const MapScore ceiling = score_map(exact.map, exact.sight, at_true_poses, slam::Pose::Identity());
  if (ceiling.f1()) metrics["map.with_true_poses.f1"] = *ceiling.f1();
  return metrics;
}

LoopScore RunJudge::loops() const {
  std::vector<TrueView> key_frames;
  for (const slam::KeyFrameRecord& k : core_.key_frames()) {
    key_frames.push_back({k.index, T_world_seen(k.index)});
  }
  std::vector<JudgedLink> links;
  for (const slam::LoopLink& link : core_.links()) {
    links.push_back(judge_link(sight_, link, T_world_seen(link.from_index), T_world_seen(link.to_index)));
  }
  return score_loops(key_frames, true_revisits(sight_, key_frames), std::move(links));
}

/// Motions from key frame to key frame of one segment as odometry knows them, with their covariances.
Metrics RunJudge::uncertainty() const {
  NeesSum sum;
  const std::vector<slam::KeyFrameRecord>& key_frames = core_.key_frames();
  for (size_t i = 1; i < key_frames.size(); ++i) {
    const slam::KeyFrameRecord& before = key_frames[i - 1];
    const slam::KeyFrameRecord& now = key_frames[i];
    if (before.segment != now.segment) continue;
    sum.add(nees(now.T_previous_left, now.covariance,
                 T_world_seen(before.index).inverse() * T_world_seen(now.index)));
  }
  return sum.metrics();
}

Metrics RunJudge::drive() const {
  if (!scene_.driven()) return {};
  return {{"drive.collisions", collisions_}};
}

std::vector<MappedView> RunJudge::mapped_views() const {
  std::vector<MappedView> views;
  for (const slam::KeyFrameRecord& k : core_.key_frames()) {
    views.push_back({k.index, k.T_map_left, source_.truth(k.index).T_world_left});
  }
  return views;
}

}  // namespace groundloop::bench
