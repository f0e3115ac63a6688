#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "slam/types/config.h"

namespace groundloop::sim {

/// Which of the two cameras a fault strikes.
enum class FaultCamera { kBoth, kLeft, kRight };

/// A pair of the span is struck with this probability, each on its own.
struct PairFault {
  double probability = 1;

  template <class Archive>
  void visit(Archive& a) {
    a("probability", probability, {.min = 0, .max = 1, .doc = "of each pair in the span"});
  }
};

struct LateFault {
  int pairs = 1;

  template <class Archive>
  void visit(Archive& a) {
    a("pairs", pairs, {.min = 1, .max = 100, .required = true, .doc = "periods by which pairs arrive late"});
  }
};

struct TriggerOffsetFault {
  double right_s = 0;  ///< right camera after the left one; negative: before

  template <class Archive>
  void visit(Archive& a) {
    a("right_s", right_s,
      {.min = -0.05, .max = 0.05, .required = true, .doc = "right camera after the left"});
  }
};

struct ExposureFault {
  double factor = 1;
  FaultCamera camera = FaultCamera::kBoth;

  template <class Archive>
  void visit(Archive& a) {
    a("factor", factor, {.min = 0.01, .max = 100, .required = true, .doc = "on every grey value"});
    a("camera", camera);
  }
};

struct FlashFault {
  double factor = 1;

  template <class Archive>
  void visit(Archive& a) {
    a("factor", factor,
      {.min = 1,
       .max = 100,
       .required = true,
       .doc = "on every grey value at first, falling to 1 at the end"});
  }
};

struct BlackoutFault {
  FaultCamera camera = FaultCamera::kBoth;

  template <class Archive>
  void visit(Archive& a) {
    a("camera", camera);
  }
};

/// Spots on a lens: they stay where they are in the image.
struct DirtFault {
  FaultCamera camera = FaultCamera::kLeft;
  int spots = 10;
  double radius_px = 30;  ///< mean; each spot has 0.5 to 1.5 times as much
  double opacity = 0.8;   ///< part of the light that a spot keeps away

  template <class Archive>
  void visit(Archive& a) {
    a("camera", camera);
    a("spots", spots, {.min = 1, .max = 1000});
    a("radius_px", radius_px, {.min = 1, .max = 1000, .doc = "mean; each spot has 0.5 to 1.5 times as much"});
    a("opacity", opacity, {.min = 0, .max = 1, .doc = "part of the light that a spot keeps away"});
  }
};

struct BlurFault {
  double sigma_px = 1;
  FaultCamera camera = FaultCamera::kBoth;

  template <class Archive>
  void visit(Archive& a) {
    a("sigma_px", sigma_px, {.min = 0.1, .max = 50, .required = true, .doc = "of a Gaussian"});
    a("camera", camera);
  }
};

/// Turns the right camera about its own centre; what the core is told of the head stays.
struct KnockFault {
  double pan_deg = 0;   ///< to the left
  double tilt_deg = 0;  ///< up
  double roll_deg = 0;  ///< about the optical axis, right side down

  template <class Archive>
  void visit(Archive& a) {
    a("pan_deg", pan_deg, {.min = -20, .max = 20, .doc = "right camera, to the left"});
    a("tilt_deg", tilt_deg, {.min = -20, .max = 20, .doc = "right camera, up"});
    a("roll_deg", roll_deg, {.min = -180, .max = 180, .doc = "right camera, its right side down"});
  }
};

/// Part of a wheel's turning that does not move the robot; the encoder counts it. Negative: the wheel skids,
/// and the robot goes farther than it turns.
struct WheelSlipFault {
  double left = 0;
  double right = 0;

  template <class Archive>
  void visit(Archive& a) {
    constexpr const char* kDoc = "part of the wheel's turning that does not move the robot";
    a("left", left, {.min = -1, .max = 0.95, .doc = kDoc});
    a("right", right, {.min = -1, .max = 0.95, .doc = kDoc});
  }
};

/// The robot is lifted and put down elsewhere at once; it does not know, and goes on with its plan from
/// there.
struct KidnapFault {
  double x_m = 0;
  double y_m = 0;
  double yaw_deg = 0;

  template <class Archive>
  void visit(Archive& a) {
    a("x_m", x_m, {.min = -1000, .max = 1000, .required = true});
    a("y_m", y_m, {.min = -1000, .max = 1000, .required = true});
    a("yaw_deg", yaw_deg, {.min = -360, .max = 360, .required = true});
  }
};

/// Part of each wheel's encoder counts that still reaches the odometry. The wheel servos have tachometers of
/// their own.
struct EncoderFault {
  double left = 1;
  double right = 1;

  template <class Archive>
  void visit(Archive& a) {
    constexpr const char* kDoc = "part of the encoder's counts that reaches the odometry";
    a("left", left, {.min = 0, .max = 1, .doc = kDoc});
    a("right", right, {.min = 0, .max = 1, .doc = kDoc});
  }
};

/// One entry of `faults:`: when, and exactly one kind.
struct Fault {
  double at_s = 0;              ///< from this time of the drive on
  std::optional<double> for_s;  ///< none: until the end

  std::optional<PairFault> drop;
  std::optional<PairFault> duplicate;
  std::optional<LateFault> late;
  std::optional<PairFault> swap;
  std::optional<TriggerOffsetFault> trigger_offset;
  std::optional<ExposureFault> exposure;
  std::optional<FlashFault> flash;
  std::optional<BlackoutFault> blackout;
  std::optional<DirtFault> dirt;
  std::optional<BlurFault> blur;
  std::optional<KnockFault> knock;
  std::optional<WheelSlipFault> wheel_slip;
  std::optional<KidnapFault> kidnap;
  std::optional<EncoderFault> encoder;

  int line = 0;  ///< in the scenario file, for messages; not part of the file

  template <class Archive>
  void visit(Archive& a) {
    a("at_s", at_s, {.min = 0, .max = 1e5, .required = true, .doc = "time of the drive"});
    a("for_s", for_s, {.min = 0.001, .max = 1e5, .doc = "until the end when not given"});
    visit_kinds(a);
  }
  template <class Archive>
  void visit_kinds(Archive& a) {
    a("drop", drop, {.doc = "pairs are lost"});
    a("duplicate", duplicate, {.doc = "the last pair delivered comes in place of a new one"});
    a("late", late, {.doc = "pairs arrive late, and are stamped on arrival"});
    a("swap", swap, {.doc = "left and right image change places"});
    a("trigger_offset", trigger_offset, {.doc = "the cameras do not expose together"});
    a("exposure", exposure, {.doc = "brighter or darker"});
    a("flash", flash, {.doc = "a burst of light that fades"});
    a("blackout", blackout, {.doc = "no light"});
    a("dirt", dirt, {.doc = "spots on a lens"});
    a("blur", blur, {.doc = "out of focus"});
    a("knock", knock, {.doc = "the right camera turns against its calibration"});
    a("wheel_slip", wheel_slip, {.doc = "wheels turn more than the robot moves"});
    a("kidnap", kidnap, {.doc = "the robot is put elsewhere at once"});
    a("encoder", encoder, {.doc = "counts are lost"});
  }
  void check(ConfigReader& reader) const;

  /// Time at which it is over, infinite when it has no end.
  double end_s() const;
  /// True from at_s until just before end_s().
  bool active(double time_s) const { return time_s >= at_s && time_s < end_s(); }
  /// Key of its kind, as in the file.
  std::string kind() const;
};

}  // namespace groundloop::sim

namespace groundloop {
template <>
struct EnumNames<sim::FaultCamera> {
  static constexpr std::array<std::pair<sim::FaultCamera, const char*>, 3> names = {
      {{sim::FaultCamera::kBoth, "both"},
       {sim::FaultCamera::kLeft, "left"},
       {sim::FaultCamera::kRight, "right"}}};
};
}  // namespace groundloop
