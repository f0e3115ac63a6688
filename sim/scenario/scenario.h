#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/scenario/camera_plan.h"
#include "sim/scenario/fault.h"
#include "sim/scenario/metric_names.h"
#include "sim/scenario/recipe.h"
#include "sim/scenario/render_choice.h"
#include "sim/scenario/scenery.h"
#include "slam/types/config.h"

namespace groundloop::sim {

/// Where the robot starts, in the world frame (body origin: on the floor below the axle).
struct StartPose {
  double x_m = 0;
  double y_m = 0;
  double yaw_deg = 0;  ///< about z, 0 looks along x, positive turns left

  int line = 0;  ///< in the scenario file, for messages; not part of the file

  template <class Archive>
  void visit(Archive& a) {
    a("x_m", x_m, {.min = -1000, .max = 1000});
    a("y_m", y_m, {.min = -1000, .max = 1000});
    a("yaw_deg", yaw_deg, {.min = -360, .max = 360, .doc = "0 looks along x, positive turns left"});
  }
};

/// How the robot differs from what its wheel control and its odometry take it for (facts: UMBmark, Borenstein
/// and Feng 1996): an open-loop drive bends, and the odometry does not see it.
struct DriveErrors {
  double diameter_ratio = 1;  ///< E_d: actual right over left wheel diameter, at the same mean
  double track_ratio = 1;     ///< E_b: actual over assumed track

  template <class Archive>
  void visit(Archive& a) {
    a("diameter_ratio", diameter_ratio, {.min = 0.5, .max = 2, .doc = "E_d: right over left wheel diameter"});
    a("track_ratio", track_ratio, {.min = 0.5, .max = 2, .doc = "E_b: actual over assumed track"});
  }
};

/// How the wheel odometry errs, beside what it shares with the drive: these ratios say by how much its own
/// idea of the robot is wrong.
struct OdometryModel {
  int counts_per_rev = 76600;  ///< encoder counts a wheel revolution
  double diameter_ratio =
      1.002;                  ///< E_d: actual right over left wheel diameter; odometry takes them as equal
  double track_ratio = 1.02;  ///< E_b: actual over nominal track
  double noise_m_per_sqrt_m = 0.005;  ///< standard deviation of a wheel's path after one metre

  template <class Archive>
  void visit(Archive& a) {
    a("counts_per_rev", counts_per_rev, {.min = 1, .max = 1e8, .doc = "encoder counts a wheel revolution"});
    a("diameter_ratio", diameter_ratio, {.min = 0.5, .max = 2, .doc = "E_d: right over left wheel diameter"});
    a("track_ratio", track_ratio, {.min = 0.5, .max = 2, .doc = "E_b: actual over nominal track"});
    a("noise_m_per_sqrt_m", noise_m_per_sqrt_m,
      {.min = 0, .max = 1, .doc = "standard deviation of a wheel's path after one metre"});
  }
};

/// `world:` one MJCF file, or a recipe to generate it by.
struct WorldChoice {
  std::string file;  ///< MJCF file, relative to the scenario file
  std::optional<WorldRecipe> generate;

  std::string& short_form() { return file; }

  template <class Archive>
  void visit(Archive& a) {
    a("file", file, {.doc = "MJCF file of the scene, relative to this file"});
    a("generate", generate, {.doc = "a furnished building drawn from a seed"});
  }
  void check(ConfigReader& reader) const;
};

struct RobotChoice {
  std::string model;  ///< MJCF file, relative to the scenario file
  StartPose start;
  DriveErrors drive;
  OdometryModel odometry;
  ArmErrors arm;

  template <class Archive>
  void visit(Archive& a) {
    a("model", model, {.required = true, .doc = "MJCF file of the robot, relative to this file"});
    a("start", start, {.doc = "where the robot starts, in the world frame"});
    a("drive", drive, {.doc = "how the robot differs from what it takes itself for"});
    a("odometry", odometry, {.doc = "errors of the wheel odometry"});
    a("arm", arm, {.doc = "errors of an arm"});
  }
};

struct HeadChoice {
  std::string model;  ///< head YAML file, relative to the scenario file

  template <class Archive>
  void visit(Archive& a) {
    a("model", model, {.required = true, .doc = "YAML file of the stereo head, relative to this file"});
  }
};

struct ArcSegment {
  double radius_m = 1;   ///< of the body origin's path; 0 turns on the spot
  double angle_deg = 0;  ///< positive turns left

  template <class Archive>
  void visit(Archive& a) {
    a("radius_m", radius_m, {.min = 0, .max = 1000, .required = true, .doc = "0 turns on the spot"});
    a("angle_deg", angle_deg, {.min = -36000, .max = 36000, .required = true, .doc = "positive turns left"});
  }
};

struct LookSegment {
  double pan_deg = 0;   ///< positive looks left
  double tilt_deg = 0;  ///< positive looks up

  template <class Archive>
  void visit(Archive& a) {
    a("pan_deg", pan_deg, {.min = -180, .max = 180, .required = true, .doc = "positive looks left"});
    a("tilt_deg", tilt_deg, {.min = -90, .max = 90, .doc = "positive looks up"});
  }
};

/// One piece of the plan: exactly one of the members is set.
struct Segment {
  std::optional<double> straight_m;  ///< negative drives backwards
  std::optional<ArcSegment> arc;
  std::optional<double> stop_s;
  std::optional<LookSegment> look;

  int line = 0;  ///< in the scenario file, for messages; not part of the file
  static constexpr bool kExactlyOneMember = true;

  template <class Archive>
  void visit(Archive& a) {
    a("straight_m", straight_m, {.min = -1000, .max = 1000, .doc = "negative drives backwards"});
    a("arc", arc, {.doc = "circle driven forwards"});
    a("stop_s", stop_s, {.min = 0, .max = 3600, .doc = "stand still"});
    a("look", look, {.doc = "turn the head, standing still (needs a robot with a pan-tilt head)"});
  }
  void check(ConfigReader& reader) const;
};

enum class Feedback { kPlan, kOdometry, kSlam, kTruth };

struct Plan {
  Feedback feedback = Feedback::kPlan;  ///< who steers: open loop, or correction by a pose
  double speed_mps = 0.2;
  double turn_rate_limit_degps = 30;  ///< arcs slow down so that the heading never turns faster
  double look_speed_degps = 20;       ///< of a head that turns
  std::vector<Segment> segments;
  std::optional<PlanRecipe> generate;  ///< in place of segments, until they are made (sim/generate)
  std::vector<CameraPose> poses;       ///< of a camera that an arm carries, in place of segments
  std::optional<CameraPath> path;      ///< in place of poses

  /// An arm carries the camera; else a robot drives.
  bool is_for_arm() const { return !poses.empty() || path.has_value(); }

  template <class Archive>
  void visit(Archive& a) {
    a("feedback", feedback, {.doc = "who steers: the plan alone (open loop), or correction by a pose"});
    a("speed_mps", speed_mps, {.min = 0.01, .max = 1.2, .required = true});
    a("turn_rate_limit_degps", turn_rate_limit_degps,
      {.min = 1, .max = 300, .doc = "arcs slow down so that the heading never turns faster"});
    a("look_speed_degps", look_speed_degps, {.min = 0.1, .max = 300, .doc = "of a head that turns"});
    a("segments", segments, {.doc = "driven one after the other"});
    a("generate", generate, {.doc = "straights and arcs through the world, drawn from a seed"});
    a("poses", poses, {.doc = "stops of a camera that an arm carries, one after the other"});
    a("path", path, {.doc = "the same, along a line"});
  }
  void check(ConfigReader& reader) const;
};

struct SlamChoice {
  std::string preset = "default";
  double scale = 1;                        ///< of the scene, relative to the room it stands for
  std::map<std::string, std::string> set;  ///< dotted option -> value, applied on top of the preset

  int preset_line = 0;                   ///< in the scenario file, for messages; 0 from a default or `--set`
  std::map<std::string, int> set_lines;  ///< option -> its line, likewise

  template <class Archive>
  void visit(Archive& a) {
    a("preset", preset, {.doc = "paper (the faithful method) or default (the best this project has)"});
    a("scale", scale,
      {.min = 0.01,
       .max = 100,
       .doc = "of the scene, relative to the room it stands for: on the core's lengths"});
    a("set", set, {.doc = "dotted options of the core and their values, on top of the preset"});
  }
};

struct Expectation {
  std::optional<double> min;
  std::optional<double> max;

  template <class Archive>
  void visit(Archive& a) {
    a("min", min);
    a("max", max);
  }
  void check(ConfigReader& reader) const;
};

/// `expect:`: metrics (docs/metrics.md) with bounds, or `outcome: lost` for a run that must fail.
struct Expectations {
  std::string outcome = "tracked";  ///< "tracked" or "lost"
  std::map<std::string, Expectation> metrics;

  template <class Archive>
  void visit(Archive& a) {
    a("outcome", outcome, {.doc = "tracked, or lost for a run that must fail"});
    for (const char* name : kMetricNames) {
      const auto found = metrics.find(name);
      auto bounds = found == metrics.end() ? std::nullopt : std::optional<Expectation>(found->second);
      a(name, bounds);
      if (bounds) metrics[name] = *bounds;
    }
  }
  void check(ConfigReader& reader) const;
};

/// One scenario file, resolved: model paths are absolute.
struct Scenario {
  int format = 1;
  std::string name;
  std::string summary;
  WorldChoice world;
  RobotChoice robot;
  HeadChoice head;
  Plan plan;
  std::vector<Person> people;
  std::vector<Move> moves;
  std::vector<LightChange> lights;
  std::vector<Fault> faults;
  RenderChoice render;
  SlamChoice slam;
  uint64_t seed = 1;
  double scale = 1;  ///< of every length of an arm's scenario, the models' included
  Expectations expect;

  std::string file;  ///< where it was read from; not part of the file

  template <class Archive>
  void visit(Archive& a) {
    a("format", format, {.required = true, .doc = "always 1"});
    a("name", name,
      {.required = true, .doc = "letters, digits, dot, dash, underscore: it names the run folder"});
    a("summary", summary, {.doc = "one line for lists and reports"});
    a("world", world,
      {.required = true, .doc = "the scene: an MJCF file, relative to this file, or {generate: ..}"});
    a("robot", robot, {.required = true});
    a("head", head, {.required = true});
    a("plan", plan, {.required = true});
    a("people", people, {.doc = "who walks about"});
    a("moves", moves, {.doc = "furniture that is put elsewhere"});
    a("lights", lights, {.doc = "lamps that are switched, dimmed or broken"});
    a("faults", faults, {.doc = "what goes wrong, and when"});
    a("render", render, {.doc = "how images are made"});
    a("slam", slam);
    a("seed", seed, {.doc = "of every noise"});
    a("scale", scale,
      {.min = 0.01, .max = 100, .doc = "every length of an arm's scenario times this, the models' included"});
    a("expect", expect, {.doc = "bounds of metrics: what must come out"});
  }
  void check(ConfigReader& reader) const;
};

/// Key and value of a `--set key=value` option: a dotted key of the scenario (plan.speed_mps, seed,
/// expect.map.f1.min, slam.preset), or `slam.` and a dotted option of the core (slam.tracking.max_features).
struct Override {
  std::string key;
  std::string value;
};

/// Defaults, then the file, then the overrides. Paths become absolute, relative to the scenario file.
/// Options of the core (`slam:`) are passed on unchecked: who knows the core checks them.
/// @throws InputError with every problem found: unknown keys, wrong types, ranges, missing files. Problems of
/// an
///         override name the file "--set".
Scenario load_scenario(const std::string& file, const std::vector<Override>& overrides = {});

/// The resolved scenario as YAML that load_scenario() accepts again.
std::string to_yaml(const Scenario& scenario);

}  // namespace groundloop::sim

namespace groundloop {
template <>
struct EnumNames<sim::Feedback> {
  static constexpr std::array<std::pair<sim::Feedback, const char*>, 4> names = {
      {{sim::Feedback::kPlan, "plan"},
       {sim::Feedback::kOdometry, "odometry"},
       {sim::Feedback::kSlam, "slam"},
       {sim::Feedback::kTruth, "truth"}}};
};
}  // namespace groundloop
