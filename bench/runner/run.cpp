#include "bench/runner/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "bench/metrics/alignment.h"
#include "bench/metrics/trajectory_file.h"
#include "bench/metrics/trajectory_metrics.h"
#include "bench/metrics/truth/map_score.h"
#include "bench/metrics/truth/stage_judge.h"
#include "bench/report/report.h"
#include "bench/runner/core_files.h"
#include "bench/runner/core_run.h"
#include "bench/runner/exact_scene.h"
#include "bench/runner/figure_recorder.h"
#include "bench/runner/output_folder.h"
#include "bench/runner/preview.h"
#include "bench/runner/provenance.h"
#include "bench/runner/run_files.h"
#include "bench/runner/run_header.h"
#include "bench/runner/simulated_source.h"
#include "bench/runner/slam_options.h"
#include "bench/runner/timing_metrics.h"
#include "sim/generate/realize.h"
#include "sim/truth/truth_world.h"
#include "slam/mapping/atomic_file.h"
#include "slam/mapping/map_io.h"
#include "slam/mapping/mapper.h"

namespace groundloop::bench {
namespace {

constexpr double kSight_m = 8.0;    // how far a cell may be to count as seen
constexpr int64_t kSightEvery = 5;  // frames between the poses whose sight is cast

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

slam::Trajectory left_truth(const SimulatedSource& source, size_t frames) {
  slam::Trajectory truth;
  for (size_t i = 0; i < frames; ++i) {
    const FrameTruth& t = source.truth(static_cast<int64_t>(i));
    truth.push_back({t.stamp_ns, t.T_world_left});
  }
  return truth;
}

/// Exact map, and what the true trajectory could see of it (sim::TruthWorld::visible_cells).
struct ExactMap {
  slam::OccupancyMap map;
  std::vector<uint8_t> sight;
};

/// Gathers what the true trajectory could see while the run goes on.
class ExactMapper {
 public:
  ExactMapper(const SceneInTime& scene, const slam::StereoRig& rig, double cell_m)
      : scene_(scene), rig_(rig) {
    exact_.map = scene.standing().occupancy(scene.standing().bounds(cell_m), kBandMin_m, kBandMax_m);
    exact_.sight.assign(exact_.map.geometry.cells(), 0);
  }

  /// Furniture was moved: a cell that has changed counts from when it is seen again.
  void look_again() {
    const slam::OccupancyMap before = exact_.map;
    exact_.map = scene_.standing().occupancy(before.geometry, kBandMin_m, kBandMax_m);
    for (size_t i = 0; i < exact_.sight.size(); ++i) {
      if (exact_.map.value[i] != before.value[i]) exact_.sight[i] = 0;
    }
  }

  void look(int64_t frame, const slam::Pose& T_world_left) {
    if (frame % kSightEvery != 0) return;
    const std::vector<uint8_t> seen = scene_.seen().visible_cells(exact_.map.geometry, rig_, {T_world_left},
                                                                  kBandMin_m, kBandMax_m, kSight_m);
    for (size_t i = 0; i < seen.size(); ++i) exact_.sight[i] = std::max(exact_.sight[i], seen[i]);
  }

  const ExactMap& exact() const { return exact_; }

 private:
  const SceneInTime& scene_;
  slam::StereoRig rig_;
  ExactMap exact_;
};

/// The ceiling of the mapper: the same points at true poses, so that its errors and the localizer's separate.
slam::OccupancyMap map_at_true_poses(const slam::Pipeline& core, const slam::StereoRig& rig,
                                     const slam::Trajectory& truth) {
  slam::Mapper mapper(rig, core.options().mapping);
  for (const slam::KeyFrameRecord& k : core.key_frames()) {
    mapper.add(truth[static_cast<size_t>(k.index)].T, k.observations);
  }
  return mapper.grid().map();
}

void write_truth(const OutputFolder& out, const ExactMap& exact, const sim::TruthWorld& world) {
  slam::write_map(out.file("truth_map"), exact.map);
  // As it is scored: a free cell that a ray crossed, an occupied one whose face was seen.
  slam::OccupancyMap visible{exact.map.geometry, {}};
  for (size_t i = 0; i < exact.sight.size(); ++i) {
    visible.value.push_back(exact.sight[i] > (exact.map.value[i] > 0 ? 1 : 0) ? 1.0F : 0.0F);
  }
  slam::write_map(out.file("visible"), visible);
  write_outline_json(out.file("outline.json"), scene_outline(world));
}

/// Of its file, or of what is generated.
std::string sha256_of_world(const sim::Scenario& scenario) {
  const auto generated = sim::generated_text(scenario);
  return generated ? sha256_of_text(*generated) : sha256_of_file(scenario.world.file);
}

RunHeader header_of(const sim::Scenario& scenario, const Metrics& metrics, const Verdict& verdict,
                    const sim::RendererInfo& renderer) {
  RunHeader header = run_header(verdict);
  header.name = scenario.name;
  header.summary = scenario.summary;
  header.seed = scenario.seed;
  header.kind = "run";
  header.preset = scenario.slam.preset;
  header.renderer = {{"backend", renderer.backend},
                     {"renderer", renderer.renderer},
                     {"version", renderer.version},
                     {"samples", std::to_string(renderer.samples)}};
  header.hashes = {{"scenario", sha256_of_file(scenario.file)},
                   {"world", sha256_of_world(scenario)},
                   {"robot", sha256_of_file(scenario.robot.model)},
                   {"head", sha256_of_file(scenario.head.model)}};
  header.judged = judged_metrics(scenario.expect, metrics, verdict);
  return header;
}

}  // namespace

RunOutcome run_scenario(const sim::Scenario& asked, std::optional<int64_t> frames,
                        const std::string& folder, const JobControl& control) {
  const Clock::time_point start = Clock::now();
  const sim::Scenario scenario = sim::realized(asked);
  const slam::SlamOptions options = slam_options(scenario);
  const sim::HeadModel head = sim::load_head(scenario.head.model);
  const sim::World world = sim::World::load(scenario);
  SimulatedSource source(scenario, world, head, frames);
  const slam::StereoRig rig = source.rig();
  OutputFolder out(folder);

  // drive, see, process
  slam::Pipeline core(rig, options);
  SceneInTime scene(world, scenario);
  const sim::TruthWorld& truth_world = scene.standing();
  StageJudge stages(scene.seen(), rig);
  ExactMapper exact_mapper(scene, rig, options.mapping.cell_m);
  FigureRecorder figures(rig, *source.size());
  std::vector<FrameNotes> notes;
  std::vector<double> render_ms;
  const auto observe = [&](const slam::StereoFrame& frame, const slam::FrameResult& result) {
    const FrameTruth& truth = source.truth(frame.index);
    if (scene.move_to(static_cast<double>(truth.seen_ns) * 1e-9)) exact_mapper.look_again();
    const StageErrors errors = stages.judge(result, truth.T_world_seen);
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    notes.push_back({truth.render_ms, errors.disparity_px.rmse().value_or(kUnknown),
                     errors.track_px.rmse().value_or(kUnknown), kUnknown, truth.faults});
    render_ms.push_back(truth.render_ms);
    exact_mapper.look(frame.index, truth.T_world_seen);
    figures.observe(frame, result, core);
  };
  const std::string name = fmt::format("{}-{}", scenario.name, scenario.seed);
  const CoreRun core_run = run_core(source, core, name, std::nullopt, observe, control);

  // compare with the truth
  RunOutcome outcome{scenario.name, scenario.seed, folder, 0, {}, {}};
  Metrics& metrics = outcome.metrics;
  const slam::Trajectory truth = left_truth(source, core_run.frames.size());
  PosePairs pairs{truth, core.trajectory()};
  metrics = trajectory_metrics(pairs);
  std::vector<slam::TrackingStatus> statuses;
  for (const slam::FrameResult& frame : core_run.frames) statuses.push_back(frame.status);
  metrics.merge(tracking_metrics(statuses));
  metrics.merge(stages.total().metrics());
  const slam::Pose T_world_map = align(pairs, AlignMode::kSe3).T_truth_map;
  for (size_t i = 0; i < pairs.size(); ++i) {
    notes[i].position_error_m = (pairs.truth[i].T.translation() - pairs.estimate[i].T.translation()).norm();
  }
  const ExactMap& exact = exact_mapper.exact();
  metrics.merge(map_metrics(score_map(exact.map, exact.sight, core.map(), T_world_map)));
  const MapScore ceiling =
      score_map(exact.map, exact.sight, map_at_true_poses(core, rig, truth), slam::Pose::Identity());
  if (ceiling.f1()) metrics["map.with_true_poses.f1"] = *ceiling.f1();
  outcome.wall_s = seconds_since(start);
  metrics.merge(timing_metrics(core_run.frames, render_ms, outcome.wall_s));
  outcome.verdict = judge(scenario.expect, metrics);

  // write it down
  slam::Trajectory odometry;
  for (size_t i = 0; i < truth.size(); ++i) {
    odometry.push_back({truth[i].stamp_ns, source.truth(static_cast<int64_t>(i)).T_odom_body});
  }
  slam::write_file_atomically(out.file("scenario.yaml"),
                              [&](std::ostream& text) { text << sim::to_yaml(scenario); });
  write_tum(out.file("truth.tum"), truth);
  write_tum(out.file("odometry.tum"), odometry);
  write_core_files(out, core);
  write_truth(out, exact, truth_world);
  write_alignment_json(out.file("alignment.json"), T_world_map);
  write_frames_csv(out.file("frames.csv"), core_run.frames, notes);
  write_metrics_json(out.file("metrics.json"), metrics);
  figures.write(out.file("figures"));
  cv::imwrite(out.file("figures/preview.png"), preview_picture(truth_world, source.simulation()));
  RunHeader header = header_of(scenario, metrics, outcome.verdict, source.renderer_info());
  header.frames = static_cast<int64_t>(core_run.frames.size());
  write_run_json(out.file("run.json"), header);
  write_report(out.path());
  out.publish();
  return outcome;
}

std::vector<RunOutcome> run(const RunOptions& options, const JobControl& control) {
  // Every scenario is read before the first is run, so that a typing error in the last does not cost an hour.
  std::vector<sim::Scenario> scenarios;
  std::vector<Problem> problems;
  for (const std::string& file : options.scenarios) {
    try {
      const sim::Scenario scenario = sim::load_scenario(file, options.set);
      slam_options(scenario);
      const SeedRange seeds = options.seeds.value_or(SeedRange{scenario.seed, scenario.seed});
      for (uint64_t seed = seeds.first;; ++seed) {
        scenarios.push_back(scenario);
        scenarios.back().seed = seed;
        if (seed == seeds.last) break;
      }
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);

  std::vector<RunOutcome> outcomes(scenarios.size());
  std::atomic<size_t> next = 0;
  std::mutex progress_mutex;
  JobControl shared = control;
  if (control.progress) {
    shared.progress = [&](const std::string& name, int64_t done, int64_t total) {
      const std::lock_guard lock(progress_mutex);
      control.progress(name, done, total);
    };
  }
  const auto work = [&] {
    for (size_t i = next++; i < scenarios.size(); i = next++) {
      const sim::Scenario& scenario = scenarios[i];
      const std::string name = fmt::format("{}-{}", scenario.name, scenario.seed);
      std::string folder = options.out.empty() ? "runs/" + name : options.out;
      if (!options.out.empty() && scenarios.size() > 1) folder += "/" + name;
      try {
        outcomes[i] = run_scenario(scenario, options.frames, folder, shared);
      } catch (const InputError& error) {
        outcomes[i] = {scenario.name, scenario.seed, "", 0, {}, bad_input(error)};
      } catch (const std::exception& error) {
        outcomes[i] = {scenario.name, scenario.seed, "", 0, {}, internal_error(error.what())};
      }
    }
  };
  std::vector<std::thread> workers;
  for (int j = 1; j < options.jobs; ++j) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  if (control.stop != nullptr && control.stop->load()) throw Interrupted();
  return outcomes;
}

}  // namespace groundloop::bench
