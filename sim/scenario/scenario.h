#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slam/types/config.h"

namespace groundloop::sim {

/// Where the robot starts, in the world frame (body origin: on the floor below the axle).
struct StartPose {
  double x_m = 0;
  double y_m = 0;
  double yaw_deg = 0;

  template <class Archive>
  void visit(Archive& a) {
    a("x_m", x_m);
    a("y_m", y_m);
    a("yaw_deg", yaw_deg, {.min = -360, .max = 360});
  }
};

struct RobotChoice {
  std::string model;  ///< MJCF file, relative to the scenario file
  StartPose start;

  template <class Archive>
  void visit(Archive& a) {
    a("model", model, {.required = true, .doc = "MJCF file of the robot"});
    a("start", start);
  }
};

struct HeadChoice {
  std::string model;  ///< head YAML file, relative to the scenario file

  template <class Archive>
  void visit(Archive& a) {
    a("model", model, {.required = true, .doc = "YAML file of the stereo head"});
  }
};

struct ArcSegment {
  double radius_m = 1;   ///< of the body origin's path; 0 turns on the spot
  double angle_deg = 0;  ///< positive turns left

  template <class Archive>
  void visit(Archive& a) {
    a("radius_m", radius_m, {.min = 0, .max = 1000, .required = true});
    a("angle_deg", angle_deg, {.min = -36000, .max = 36000, .required = true});
  }
};

struct LookSegment {
  double pan_deg = 0;  ///< positive looks left

  template <class Archive>
  void visit(Archive& a) {
    a("pan_deg", pan_deg, {.min = -180, .max = 180, .required = true});
  }
};

/// One piece of the plan: exactly one of the members is set.
struct Segment {
  std::optional<double> straight_m;  ///< negative drives backwards
  std::optional<ArcSegment> arc;
  std::optional<double> stop_s;
  std::optional<LookSegment> look;

  template <class Archive>
  void visit(Archive& a) {
    a("straight_m", straight_m, {.min = -1000, .max = 1000});
    a("arc", arc);
    a("stop_s", stop_s, {.min = 0, .max = 3600});
    a("look", look);
  }
  void check(ConfigReader& reader) const;
};

enum class Feedback { kPlan, kOdometry, kSlam, kTruth };

struct Plan {
  Feedback feedback = Feedback::kPlan;  ///< who steers: open loop, or correction by a pose
  double speed_mps = 0.2;
  double turn_rate_limit_degps = 30;  ///< arcs slow down so that the heading never turns faster
  std::vector<Segment> segments;

  template <class Archive>
  void visit(Archive& a) {
    a("feedback", feedback);
    a("speed_mps", speed_mps, {.min = 0.01, .max = 1.2, .required = true});
    a("turn_rate_limit_degps", turn_rate_limit_degps, {.min = 1, .max = 300});
    a("segments", segments, {.required = true});
  }
  void check(ConfigReader& reader) const;
};

/// How images are made. Every combination gives the same bytes in every run.
struct RenderChoice {
  int antialiasing = 4;     ///< multisamples: 0 (none), 2 or 4
  bool reflections = true;  ///< MuJoCo reflects in one geom of the scene
  bool shadows = false;

  template <class Archive>
  void visit(Archive& a) {
    a("antialiasing", antialiasing, {.min = 0, .max = 4});
    a("reflections", reflections);
    a("shadows", shadows);
  }
};

struct SlamChoice {
  std::string preset = "default";
  std::map<std::string, std::string> set;  ///< dotted option -> value, applied on top of the preset

  template <class Archive>
  void visit(Archive& a) {
    a("preset", preset);
    a("set", set);
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

/// `expect:`: metrics of design.md section 6 with bounds, or `outcome: lost` for a run that must fail.
struct Expectations {
  std::string outcome = "tracked";  ///< "tracked" or "lost"
  std::map<std::string, Expectation> metrics;
};

/// One scenario file, resolved: model paths are absolute.
struct Scenario {
  int format = 1;
  std::string name;
  std::string summary;
  std::string world;
  RobotChoice robot;
  HeadChoice head;
  Plan plan;
  RenderChoice render;
  SlamChoice slam;
  uint64_t seed = 1;
  Expectations expect;

  std::string file;  ///< where it was read from; not part of the file
};

/// Key and value of a `--set key=value` option.
struct Override {
  std::string key;
  std::string value;
};

/// Defaults, then the file, then the overrides. Paths become absolute, relative to the scenario file.
/// @throws InputError with every problem found: unknown keys, wrong types, ranges, missing files.
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
