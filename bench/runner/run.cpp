#include "bench/runner/run.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <future>
#include <limits>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "bench/metrics/trajectory_file.h"
#include "bench/report/report.h"
#include "bench/runner/core_files.h"
#include "bench/runner/core_run.h"
#include "bench/runner/exact_scene.h"
#include "bench/runner/figure_recorder.h"
#include "bench/runner/output_folder.h"
#include "bench/runner/preview.h"
#include "bench/runner/priority.h"
#include "bench/runner/provenance.h"
#include "bench/runner/run_files.h"
#include "bench/runner/run_header.h"
#include "bench/runner/run_judge.h"
#include "bench/runner/simulated_source.h"
#include "bench/runner/slam_options.h"
#include "bench/runner/timing_metrics.h"
#include "bench/runner/truth_oracle.h"
#include "sim/generate/realize.h"
#include "sim/head/calibration_file.h"
#include "sim/simulation/carried_head.h"
#include "slam/mapping/atomic_file.h"
#include "slam/mapping/map_io.h"

namespace groundloop::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void write_truth(const OutputFolder& out, const ExactMap& exact, const sim::TruthWorld& world,
                 const MapBand& band) {
  slam::write_map(out.file("truth_map"), exact.map);
  // As it is scored: a free cell that a ray crossed, an occupied one whose face was seen.
  slam::OccupancyMap visible{exact.map.geometry, {}};
  for (size_t i = 0; i < exact.sight.size(); ++i) {
    visible.value.push_back(exact.sight[i] > (exact.map.value[i] > 0 ? 1 : 0) ? 1.0F : 0.0F);
  }
  slam::write_map(out.file("visible"), visible);
  write_outline_json(out.file("outline.json"), scene_outline(world, band));
}

/// Of its file, or of what is generated.
std::string sha256_of_world(const sim::Scenario& scenario) {
  const auto generated = sim::generated_text(scenario);
  return generated ? sha256_of_text(*generated) : sha256_of_file(scenario.world.file);
}

std::string profile_name(sim::RenderProfile profile) {
  for (const auto& [candidate, name] : EnumNames<sim::RenderProfile>::names) {
    if (candidate == profile) return name;
  }
  return "";
}

/// What the pixels of a run depend on that no scenario says.
std::string preflight_line(const sim::Scenario& scenario, const sim::RendererInfo& renderer) {
  return fmt::format("{}, {}, {} sample{} a pixel, {}, profile {}", renderer.backend, renderer.renderer,
                     std::max(renderer.samples, 1), renderer.samples > 1 ? "s" : "", instruction_set(),
                     profile_name(scenario.render.profile));
}

RunHeader header_of(const sim::Scenario& scenario, const RunOutcome& outcome,
                    const sim::RendererInfo& renderer) {
  RunHeader header = run_header(outcome.verdict);
  header.name = scenario.name;
  header.summary = scenario.summary;
  header.seed = scenario.seed;
  header.kind = "run";
  header.preset = scenario.slam.preset;
  header.oracles = name_of(outcome.oracles);
  header.renderer = {{"backend", renderer.backend},
                     {"renderer", renderer.renderer},
                     {"version", renderer.version},
                     {"samples", std::to_string(renderer.samples)},
                     {"profile", profile_name(scenario.render.profile)}};
  header.hashes = {{"scenario", sha256_of_file(scenario.file)},
                   {"world", sha256_of_world(scenario)},
                   {"robot", sha256_of_file(scenario.robot.model)},
                   {"head", sha256_of_file(scenario.head.model)}};
  header.judged = judged_metrics(scenario.expect, outcome.metrics, outcome.verdict);
  return header;
}

void write_motion(const OutputFolder& out, const SimulatedSource& source, const RunJudgement& judged) {
  slam::Trajectory odometry;
  for (size_t i = 0; i < judged.truth.size(); ++i) {
    odometry.push_back({judged.truth[i].stamp_ns, source.truth(static_cast<int64_t>(i)).T_odom_body});
  }
  write_tum(out.file("truth.tum"), judged.truth);
  write_tum(out.file("odometry.tum"), odometry);
  write_alignment_json(out.file("alignment.json"), judged.T_world_map);
  if (!judged.links.empty()) write_links_csv(out.file("links.csv"), judged.links);
  if (!judged.without_links.empty()) write_tum(out.file("without_links.tum"), judged.without_links);
}

}  // namespace

std::string name_of(const OracleStages& stages) {
  std::string text;
  for (const auto& [stage, name] : EnumNames<slam::OracleStage>::names) {
    if (stages.contains(stage)) text += (text.empty() ? "" : "+") + std::string(name);
  }
  return text;
}

std::string RunOutcome::title() const {
  return oracles.empty() ? name : fmt::format("{} (exact {})", name, name_of(oracles));
}

RunOutcome run_scenario(const RunJob& job, const JobControl& control) {
  const Clock::time_point start = Clock::now();
  const sim::Scenario scenario = sim::realized(job.scenario);
  const slam::SlamOptions options = slam_options(scenario);
  const sim::HeadModel head = sim::carried_head(scenario);
  std::future<sim::RendererInfo> renderer_found = renderer_from_behind(scenario.render.settings());
  const sim::World world = sim::World::load(scenario, sim::Looks::kNone);
  const sim::RendererInfo renderer = renderer_found.get();
  SimulatedSource source(scenario, world, head, renderer, job.frames, job.cache);
  OutputFolder out(job.folder);

  // drive, see, process
  SceneInTime scene(world, scenario);
  const sim::TruthWorld still = exact_scene(world);
  const TruthOracle oracle(job.oracles, still, source.rig(),
                           [&source](int64_t frame) { return source.truth(frame).T_world_seen; });
  slam::Pipeline core(source.rig(), options, job.oracles.empty() ? nullptr : &oracle);
  RunJudge judge(scene, source, core);
  FigureRecorder figures(source.rig(), *source.size(), out.file("figures"));
  std::future<void> preview = std::async(std::launch::async, [&] {
    stand_back();
    cv::imwrite(out.file("figures/preview.png"), preview_picture(world, scenario, source.simulation()));
  });
  std::vector<FrameNotes> notes;
  const auto observe = [&](const slam::StereoFrame& frame, const slam::FrameResult& result) {
    source.steer_by(result);
    const FrameTruth& truth = source.truth(frame.index);
    judge.observe(frame, result);
    notes.push_back({.render_ms = truth.render_ms,
                     .disparity_error_px = kUnknown,
                     .track_error_px = kUnknown,
                     .position_error_m = kUnknown,
                     .memory_mb = memory_mb(),
                     .faults = truth.faults,
                     .exposure_s = truth.setting ? truth.setting->time_s : kUnknown,
                     .gain_db = truth.setting ? truth.setting->gain_db : kUnknown});
    figures.observe(frame, result, core);
  };
  RunOutcome outcome{scenario.name, scenario.seed, job.folder, 0, {}, {}, job.oracles};
  const std::string name = fmt::format("{}-{}", outcome.title(), scenario.seed);
  if (control.note) control.note(name, preflight_line(scenario, renderer));
  const CoreRun core_run =
      run_core(source, core, name, std::nullopt, observe, control, [&source] { source.abandon(); });

  // compare with the truth
  std::future<void> map3d = map3d_beside(out, core);
  const RunJudgement judged = judge.judge(core_run.frames);
  std::vector<double> render_ms;
  for (size_t i = 0; i < notes.size(); ++i) {
    notes[i].disparity_error_px = judged.stages[i].disparity_px.rmse().value_or(kUnknown);
    notes[i].track_error_px = judged.stages[i].track_px.rmse().value_or(kUnknown);
    notes[i].position_error_m = judged.position_error_m[i];
    render_ms.push_back(notes[i].render_ms);
  }
  outcome.metrics = judged.metrics;
  outcome.wall_s = seconds_since(start);
  outcome.metrics.merge(timing_metrics(core_run.frames, render_ms, outcome.wall_s));
  outcome.verdict = bench::judge(scenario.expect, outcome.metrics);

  // write it down
  slam::write_file_atomically(out.file("scenario.yaml"),
                              [&](std::ostream& text) { text << sim::to_yaml(scenario); });
  if (head.raw) {
    slam::write_file_atomically(out.file("calibration.yaml"),
                                [&](std::ostream& text) { text << sim::calibration_yaml(head); });
  }
  write_motion(out, source, judged);
  write_core_files(out, core);
  write_truth(out, judge.exact_map(), scene.standing(), scene.band());
  write_frames_csv(out.file("frames.csv"), core_run.frames, notes);
  write_metrics_json(out.file("metrics.json"), outcome.metrics);
  RunHeader header = header_of(scenario, outcome, renderer);
  header.frames = static_cast<int64_t>(core_run.frames.size());
  write_run_json(out.file("run.json"), header);
  figures.finish();
  preview.get();
  write_report(out.path());
  map3d.get();
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

  const std::unique_ptr<sim::PairCache> cache = open_cache(options.cache);
  std::vector<RunJob> jobs;
  for (const sim::Scenario& scenario : scenarios) {
    std::string name = fmt::format("{}-{}", scenario.name, scenario.seed);
    if (!options.oracles.empty()) name += "-exact-" + name_of(options.oracles);
    std::string folder = options.out.empty() ? "runs/" + name : options.out;
    if (!options.out.empty() && scenarios.size() > 1) folder += "/" + name;
    jobs.push_back({scenario, options.frames, options.oracles, folder, cache.get()});
  }
  std::vector<RunOutcome> outcomes = run_all(jobs, options.jobs, control);
  if (cache && cache->stored() > 0) cache->trim();
  return outcomes;
}

std::unique_ptr<sim::PairCache> open_cache(const CacheChoice& choice) {
  if (choice.folder.empty()) return nullptr;
  return std::make_unique<sim::PairCache>(choice.folder, choice.max_bytes);
}

std::vector<RunOutcome> run_all(const std::vector<RunJob>& jobs, int at_once, const JobControl& control) {
  std::vector<RunOutcome> outcomes(jobs.size());
  std::atomic<size_t> next = 0;
  std::mutex progress_mutex;
  JobControl shared = control;
  if (control.progress) {
    shared.progress = [&](const std::string& name, int64_t done, int64_t total) {
      const std::lock_guard lock(progress_mutex);
      control.progress(name, done, total);
    };
  }
  if (control.note) {
    shared.note = [&](const std::string& name, const std::string& line) {
      const std::lock_guard lock(progress_mutex);
      control.note(name, line);
    };
  }
  const auto work = [&] {
    for (size_t i = next++; i < jobs.size(); i = next++) {
      const RunJob& job = jobs[i];
      const auto failed = [&job](const Verdict& verdict) {
        return RunOutcome{job.scenario.name, job.scenario.seed, "", 0, {}, verdict, job.oracles};
      };
      try {
        outcomes[i] = run_scenario(job, shared);
      } catch (const InputError& error) {
        outcomes[i] = failed(bad_input(error));
      } catch (const std::exception& error) {
        outcomes[i] = failed(internal_error(error.what()));
      }
    }
  };
  std::vector<std::thread> workers;
  for (int j = 1; j < at_once; ++j) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  if (control.stop != nullptr && control.stop->load()) throw Interrupted();
  return outcomes;
}

}  // namespace groundloop::bench
