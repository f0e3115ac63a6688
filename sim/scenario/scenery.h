#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slam/types/config.h"

namespace groundloop::sim {

/// A point of a person's way, on the floor.
struct WayPoint {
  double x_m = 0;
  double y_m = 0;

  template <class Archive>
  void visit(Archive& a) {
    a("x_m", x_m, {.min = -1000, .max = 1000, .required = true});
    a("y_m", y_m, {.min = -1000, .max = 1000, .required = true});
  }
};

/// Someone who walks along way points, and stands before and after.
struct Person {
  std::string name;
  std::string model;  ///< MJCF file of the person, relative to the scenario file
  double at_s = 0;    ///< sets out
  double speed_mps = 1;
  bool back_and_forth = false;  ///< walks the way again and again instead of standing at its end
  std::vector<WayPoint> way;

  int line = 0;  ///< in the scenario file, for messages; not part of the file

  template <class Archive>
  void visit(Archive& a) {
    a("name", name, {.required = true, .doc = "letters, digits, dash, underscore"});
    a("model", model, {.required = true, .doc = "MJCF file of the person, relative to this file"});
    a("at_s", at_s, {.min = 0, .max = 1e5, .doc = "sets out"});
    a("speed_mps", speed_mps, {.min = 0.05, .max = 5});
    a("back_and_forth", back_and_forth, {.doc = "walk the way again and again"});
    a("way", way,
      {.required = true, .doc = "points on the floor, at least one; the first is where it stands"});
  }
  void check(ConfigReader& reader) const;
};

/// A body of the world that someone puts elsewhere: from `at_s` on it stands there, at its height.
struct Move {
  double at_s = 0;
  std::string body;
  double x_m = 0;
  double y_m = 0;
  double yaw_deg = 0;  ///< of the body's x axis

  int line = 0;  ///< in the scenario file, for messages; not part of the file

  template <class Archive>
  void visit(Archive& a) {
    a("at_s", at_s, {.min = 0, .max = 1e5, .required = true, .doc = "from then on it stands there"});
    a("body", body, {.required = true, .doc = "name of a body of the world that has no joint"});
    a("x_m", x_m, {.min = -1000, .max = 1000, .required = true});
    a("y_m", y_m, {.min = -1000, .max = 1000, .required = true});
    a("yaw_deg", yaw_deg, {.min = -360, .max = 360, .required = true, .doc = "of the body's x axis"});
  }
};

/// Brightness that wavers: every 1 / rate_hz it is another factor between 1 - depth and 1.
struct Flicker {
  double rate_hz = 10;
  double depth = 1;

  template <class Archive>
  void visit(Archive& a) {
    a("rate_hz", rate_hz, {.min = 0.01, .max = 1000, .required = true, .doc = "new brightness so often"});
    a("depth", depth, {.min = 0, .max = 1, .required = true, .doc = "1: down to darkness"});
  }
};

/// A lamp that is switched, dimmed or broken for a while.
struct LightChange {
  double at_s = 0;
  std::optional<double> for_s;  ///< none: until the end
  std::string light = "all";    ///< name of a light of the world, "ambient", or "all"
  double factor = 1;            ///< on its brightness
  std::optional<Flicker> flicker;

  int line = 0;  ///< in the scenario file, for messages; not part of the file

  template <class Archive>
  void visit(Archive& a) {
    a("at_s", at_s, {.min = 0, .max = 1e5, .required = true});
    a("for_s", for_s, {.min = 0.001, .max = 1e5, .doc = "until the end when not given"});
    a("light", light, {.doc = "name of a light of the world, ambient, or all"});
    a("factor", factor, {.min = 0, .max = 10, .doc = "on its brightness; 0 switches it off"});
    a("flicker", flicker);
  }
};

}  // namespace groundloop::sim
