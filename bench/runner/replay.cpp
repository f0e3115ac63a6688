#include "bench/runner/replay.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>

#include "bench/metrics/alignment.h"
#include "bench/metrics/point_truth.h"
#include "bench/metrics/trajectory_file.h"
#include "bench/metrics/trajectory_metrics.h"
#include "bench/report/report.h"
#include "bench/runner/core_files.h"
#include "bench/runner/core_run.h"
#include "bench/runner/figure_recorder.h"
#include "bench/runner/output_folder.h"
#include "bench/runner/provenance.h"
#include "bench/runner/run_files.h"
#include "bench/runner/run_header.h"
#include "bench/runner/slam_options.h"
#include "bench/runner/timing_metrics.h"
#include "slam/source/euroc_source.h"
#include "slam/source/kitti_source.h"

namespace groundloop::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Truths of recorded cameras are in the axes of the first left camera, whose y points down.
const Eigen::Vector3d kUpInFirstCamera = -Eigen::Vector3d::UnitY();

bool out_of_order(const slam::StereoSource& source) {
  const auto* kitti = dynamic_cast<const slam::KittiSource*>(&source);
  return kitti != nullptr && kitti->out_of_order();
}

std::unique_ptr<slam::StereoSource> open_source(const ReplayOptions& options) {
  if (!fs::is_directory(options.dir)) {
    throw InputError(Problem{options.dir, 0, "", "no such folder", "a recorded stereo sequence"});
  }
  std::string format = options.format;
  if (format.empty()) {
    const bool euroc = fs::exists(options.dir + "/mav0") || fs::exists(options.dir + "/cam0");
    format = euroc ? "euroc" : "kitti";
  }
  const slam::SourceOptions how{.calibration_files = options.calibration};
  if (format == "kitti") return std::make_unique<slam::KittiSource>(options.dir, how);
  if (format == "euroc") return std::make_unique<slam::EurocSource>(options.dir, how);
  throw InputError(Problem{"--format", 0, "", options.format, "kitti or euroc"});
}

/// What a sequence says of its own motion: whole poses, or one point's path on the floor.
struct RecordedTruth {
  slam::Trajectory poses;
  PointTruth point;
};

/// Poses of a file without stamps are those of the pairs, in order.
slam::Trajectory stamped(TrajectoryFile file, const slam::Trajectory& estimate, bool rearranged) {
  if (file.has_stamps()) return file.poses;
  if (rearranged) {
    throw InputError(Problem{file.file, 0, "", "poses without times",
                             "a file with times (gt.tum), as times.txt goes back"});
  }
  if (file.poses.size() < estimate.size()) {
    throw InputError(Problem{file.file, 0, "", std::to_string(file.poses.size()) + " poses",
                             "one a pair, that is " + std::to_string(estimate.size())});
  }
  file.poses.resize(estimate.size());
  for (size_t i = 0; i < estimate.size(); ++i) file.poses[i].stamp_ns = estimate[i].stamp_ns;
  return file.poses;
}

RecordedTruth find_truth(const ReplayOptions& options, const slam::Trajectory& estimate, bool rearranged) {
  const StampOrder order = rearranged ? StampOrder::kAny : StampOrder::kRising;
  if (!options.truth.empty())
    return {stamped(read_trajectory(options.truth, order), estimate, rearranged), {}};
  for (const char* name : {"/gt.tum", "/poses.txt"}) {
    const std::string file = options.dir + name;
    if (fs::exists(file)) return {stamped(read_trajectory(file, order), estimate, rearranged), {}};
  }
  const std::string point = options.dir + "/gt_point.tum";
  if (fs::exists(point)) return {{}, read_point_truth(point)};
  return {};
}

std::string name_of_folder(const std::string& dir) {
  fs::path path = fs::absolute(dir).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  return path.filename().string();
}

}  // namespace

RunOutcome replay(const ReplayOptions& options, const JobControl& control) {
  const Clock::time_point start = Clock::now();
  const std::string name = name_of_folder(options.dir);
  const slam::SlamOptions core_options = slam_options(options.preset, options.set);
  const std::unique_ptr<slam::StereoSource> source = open_source(options);
  const std::string folder = options.out.empty() ? "runs/" + name : options.out;
  OutputFolder out(folder);
  if (out_of_order(*source)) {
    fmt::print(stderr, "{}/times.txt: warning: times go back; the pairs are taken in order of time\n",
               options.dir);
  }

  slam::Pipeline core(source->rig(), core_options);
  const int64_t frames = std::min(options.frames.value_or(INT64_MAX), source->size().value_or(INT64_MAX));
  FigureRecorder figures(source->rig(), frames == INT64_MAX ? 0 : frames, out.file("figures"));
  std::vector<double> memory;
  const auto observe = [&](const slam::StereoFrame& frame, const slam::FrameResult& result) {
    figures.observe(frame, result, core);
    memory.push_back(memory_mb());
  };
  const CoreRun core_run = run_core(*source, core, name, options.frames, observe, control);
  std::future<void> map3d = map3d_beside(out, core);

  RunOutcome outcome{name, 0, folder, 0, {}, {}, {}};
  Metrics& metrics = outcome.metrics;
  metrics = tracking_metrics(core_run.frames);
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<FrameNotes> notes(core_run.frames.size(),
                                {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, ""});
  for (size_t i = 0; i < notes.size(); ++i) notes[i].memory_mb = memory[i];
  const RecordedTruth truth = find_truth(options, core.trajectory(), out_of_order(*source));
  std::optional<slam::Pose> T_world_map;
  if (!truth.poses.empty()) {
    PosePairs pairs = associate_by_time(truth.poses, core.trajectory());
    metrics.merge(trajectory_metrics(pairs, kUpInFirstCamera));
    if (pairs.size() > 0) T_world_map = align(pairs, AlignMode::kSe3).T_truth_map;
  }
  if (const auto fit = fit_planar(truth.point, core.trajectory())) {
    metrics.merge(planar_metrics(*fit));
    T_world_map = fit->T_world_map;
  }
  outcome.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  metrics.merge(timing_metrics(core_run.frames, {}, outcome.wall_s));
  const sim::Expectations expected;
  outcome.verdict = judge(expected, metrics);

  if (!truth.poses.empty()) write_tum(out.file("truth.tum"), truth.poses);
  if (T_world_map) write_alignment_json(out.file("alignment.json"), *T_world_map);
  write_core_files(out, core);
  std::vector<JudgedLink> links;
  for (const slam::LoopLink& link : core.links())
    links.push_back({link, kUnknown, kUnknown, kUnknown, false});
  if (!links.empty()) write_links_csv(out.file("links.csv"), links);
  write_frames_csv(out.file("frames.csv"), core_run.frames, notes);
  write_metrics_json(out.file("metrics.json"), metrics);
  figures.finish();
  RunHeader header = run_header(outcome.verdict);
  header.name = name;
  header.summary = "Recorded sequence of " + std::to_string(core_run.frames.size()) + " stereo pairs.";
  header.kind = "replay";
  header.preset = options.preset;
  header.frames = static_cast<int64_t>(core_run.frames.size());
  for (const char* file : {"calib.txt", "times.txt"}) {
    const std::string hash = sha256_of_file(options.dir + "/" + file);
    if (!hash.empty()) header.hashes[file] = hash;
  }
  header.judged = judged_metrics(expected, metrics, outcome.verdict);
  write_run_json(out.file("run.json"), header);
  write_report(out.path());
  map3d.get();
  out.publish();
  return outcome;
}

}  // namespace groundloop::bench
