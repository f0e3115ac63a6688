#pragma once

#include <optional>
#include <vector>

#include "slam/types/config.h"

namespace groundloop::sim {

/// One stop of a camera that an arm carries: pose of the left image's camera in the world.
struct CameraPose {
  std::optional<double> at_s;  ///< of its first pair; none: one pair after the pose before
  double x_m = 0;
  double y_m = 0;
  double z_m = 0;
  double yaw_deg = 0;   ///< of the look direction about z: 0 looks along x, positive to the left
  double tilt_deg = 0;  ///< of the look direction: positive looks up

  int line = 0;  ///< in the scenario file, for messages; not part of the file

  template <class Archive>
  void visit(Archive& a) {
    a("at_s", at_s,
      {.min = 0, .max = 1e6, .doc = "of its first pair; one pair after the pose before when not given"});
    a("x_m", x_m, {.min = -100, .max = 100, .required = true});
    a("y_m", y_m, {.min = -100, .max = 100, .required = true});
    a("z_m", z_m, {.min = -100, .max = 100, .required = true});
    a("yaw_deg", yaw_deg,
      {.min = -360, .max = 360, .doc = "look direction: 0 is along x, positive turns left"});
    a("tilt_deg", tilt_deg, {.min = -90, .max = 90, .doc = "look direction: positive is up"});
  }
};

struct ArcPiece {
  double radius_m = 1;   ///< of the camera's path; 0 turns on the spot
  double angle_deg = 0;  ///< positive turns left

  template <class Archive>
  void visit(Archive& a) {
    a("radius_m", radius_m, {.min = 0, .max = 100, .required = true, .doc = "0 turns on the spot"});
    a("angle_deg", angle_deg, {.min = -3600, .max = 3600, .required = true, .doc = "positive turns left"});
  }
};

/// One piece of a driven path: exactly one of the members is set.
struct PathPiece {
  std::optional<double> straight_m;  ///< negative goes backwards
  std::optional<double> sideways_m;  ///< positive goes to the left
  std::optional<ArcPiece> arc;

  static constexpr bool kExactlyOneMember = true;

  template <class Archive>
  void visit(Archive& a) {
    a("straight_m", straight_m, {.min = -100, .max = 100, .doc = "negative goes backwards"});
    a("sideways_m", sideways_m, {.min = -100, .max = 100, .doc = "positive goes to the left"});
    a("arc", arc, {.doc = "circle, the camera turning along"});
  }
  void check(ConfigReader& reader) const;
};

/// The camera goes as a robot with a fixed head would drive.
struct DrivePath {
  double x_m = 0;  ///< where it begins
  double y_m = 0;
  double yaw_deg = 0;   ///< heading there
  double look_deg = 0;  ///< of the camera from the heading, positive to the left
  std::vector<PathPiece> pieces;

  template <class Archive>
  void visit(Archive& a) {
    a("x_m", x_m, {.min = -100, .max = 100, .required = true});
    a("y_m", y_m, {.min = -100, .max = 100, .required = true});
    a("yaw_deg", yaw_deg, {.min = -360, .max = 360, .doc = "heading at the start"});
    a("look_deg", look_deg,
      {.min = -360, .max = 360, .doc = "of the camera from the heading, positive to the left"});
    a("pieces", pieces, {.required = true, .doc = "one after the other"});
  }
};

/// Rows to and fro across the look direction, each nearer to what is looked at than the one before.
struct RasterPath {
  double x_m = 0;  ///< middle of the first row
  double y_m = 0;
  double yaw_deg = 0;  ///< look direction, everywhere
  double width_m = 0;  ///< of a row
  double depth_m = 0;  ///< from the first row to the last
  int rows = 2;

  template <class Archive>
  void visit(Archive& a) {
    a("x_m", x_m, {.min = -100, .max = 100, .required = true, .doc = "middle of the first row"});
    a("y_m", y_m, {.min = -100, .max = 100, .required = true});
    a("yaw_deg", yaw_deg, {.min = -360, .max = 360, .doc = "look direction, everywhere"});
    a("width_m", width_m, {.min = 0.001, .max = 100, .required = true, .doc = "of a row"});
    a("depth_m", depth_m, {.min = 0, .max = 100, .doc = "from the first row to the last, forwards"});
    a("rows", rows, {.min = 1, .max = 1000});
  }
};

/// `plan: {path: {...}}`: stops at a constant height, made by a named generator.
struct CameraPath {
  double z_m = 0;
  double tilt_deg = 0;
  double step_m = 0.01;  ///< longest way between two stops
  double step_deg = 2;   ///< widest turn between two stops
  std::optional<DrivePath> drive;
  std::optional<RasterPath> raster;

  int line = 0;  ///< in the scenario file, for messages; not part of the file

  template <class Archive>
  void visit(Archive& a) {
    a("z_m", z_m, {.min = -100, .max = 100, .required = true, .doc = "height, everywhere"});
    a("tilt_deg", tilt_deg, {.min = -90, .max = 90, .doc = "look direction: positive is up"});
    a("step_m", step_m, {.min = 0.0001, .max = 10, .doc = "longest way between two stops"});
    a("step_deg", step_deg, {.min = 0.01, .max = 90, .doc = "widest turn between two stops"});
    a("drive", drive, {.doc = "as a robot with a fixed head would drive"});
    a("raster", raster, {.doc = "rows to and fro across the look direction"});
  }
  void check(ConfigReader& reader) const;
};

/// Where the camera really sits, seen from where it is believed to sit on the arm's hand.
struct HandEyeError {
  double x_m = 0;       ///< to the right in the image
  double y_m = 0;       ///< down
  double z_m = 0;       ///< forward
  double pan_deg = 0;   ///< turned to the left
  double tilt_deg = 0;  ///< turned up
  double roll_deg = 0;  ///< right side turned down

  template <class Archive>
  void visit(Archive& a) {
    a("x_m", x_m, {.min = -0.1, .max = 0.1, .doc = "to the right in the image"});
    a("y_m", y_m, {.min = -0.1, .max = 0.1, .doc = "down"});
    a("z_m", z_m, {.min = -0.1, .max = 0.1, .doc = "forward"});
    a("pan_deg", pan_deg, {.min = -10, .max = 10, .doc = "turned to the left"});
    a("tilt_deg", tilt_deg, {.min = -10, .max = 10, .doc = "turned up"});
    a("roll_deg", roll_deg, {.min = -10, .max = 10, .doc = "right side turned down"});
  }
};

/// How an arm errs.
struct ArmErrors {
  double repeatability_m = 0;    ///< standard deviation of each coordinate of the hand, at every stop anew
  double repeatability_deg = 0;  ///< the same of its rotation about each axis
  HandEyeError hand_eye;

  template <class Archive>
  void visit(Archive& a) {
    a("repeatability_m", repeatability_m,
      {.min = 0,
       .max = 0.01,
       .doc = "standard deviation of each coordinate of the hand, at every stop anew"});
    a("repeatability_deg", repeatability_deg,
      {.min = 0, .max = 1, .doc = "standard deviation of its rotation about each axis, at every stop anew"});
    a("hand_eye", hand_eye, {.doc = "where the camera really sits, from where it is believed to sit"});
  }
};

}  // namespace groundloop::sim
