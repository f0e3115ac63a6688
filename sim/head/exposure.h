#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "slam/types/config.h"

namespace groundloop::sim {

/// Automatic exposure: the mean grey value of a delivered left image decides the exposure `lag_frames` later.
struct AutoExposureModel {
  double target_grey = 100;  ///< mean of the image above the sensor's black level
  int lag_frames = 2;
  double speed = 0.5;  ///< part of the error, in stops, that one decision removes
  double min_time_s = 0.0005;
  double max_time_s = 0.015;
  double max_gain_db = 18;  ///< used once the time is at its longest

  template <class Archive>
  void visit(Archive& a) {
    a("target_grey", target_grey, {.min = 5, .max = 250});
    a("lag_frames", lag_frames, {.min = 1, .max = 30});
    a("speed", speed, {.min = 0.01, .max = 1});
    a("min_time_s", min_time_s, {.min = 1e-6, .max = 1});
    a("max_time_s", max_time_s, {.min = 1e-6, .max = 1});
    a("max_gain_db", max_gain_db, {.min = 0, .max = 60});
  }
  void check(ConfigReader& reader) const;
};

/// Shutter and gain of a head.
struct ExposureModel {
  double time_s = 0.008;     ///< how long each pixel collects light; at the first frame under `auto`
  double gain_db = 0;        ///< on top of the sensor's gain; the least under `auto`
  double readout_s = 0;      ///< rolling shutter: from the first row's exposure to the last's; 0: all at once
  int sub_frames = 1;        ///< moments at which the scene is rendered, evenly over the whole exposure
  double right_gain_db = 0;  ///< the right camera's gain beyond the left one's
  double right_time_factor = 1;                ///< its exposure time over the left one's
  double right_trigger_offset_s = 0;           ///< right camera after the left one
  std::optional<AutoExposureModel> automatic;  ///< key `auto`

  template <class Archive>
  void visit(Archive& a) {
    a("time_s", time_s, {.min = 1e-6, .max = 1});
    a("gain_db", gain_db, {.min = -20, .max = 60});
    a("readout_s", readout_s, {.min = 0, .max = 1});
    a("sub_frames", sub_frames, {.min = 1, .max = 64});
    a("right_gain_db", right_gain_db, {.min = -20, .max = 20});
    a("right_time_factor", right_time_factor, {.min = 0.1, .max = 10});
    a("right_trigger_offset_s", right_trigger_offset_s, {.min = -0.05, .max = 0.05});
    a("auto", automatic);
  }

  /// What one frame may last at most, from the first row's first light to the last row's last: the span over
  /// which the sub-frames are spread, whatever the exposure chosen for the frame.
  double longest_s() const;
  /// When the scene is rendered, from the frame's stamp: the middles of `sub_frames` equal parts of the span.
  /// The stamp is the middle of the middle row's exposure.
  std::vector<double> sub_frame_times_s() const;
};

/// How long and with which gain one camera takes one frame.
struct ExposureSetting {
  double time_s = 0;
  double gain_db = 0;
  bool operator==(const ExposureSetting&) const = default;
};

/// The right camera's setting beside the left one's.
ExposureSetting right_setting(const ExposureModel& model, const ExposureSetting& left);

/// Weights of the sub-frames in one row: the parts of its exposure that fall into their parts of the span.
/// Sum 1.
std::vector<float> shutter_weights(const ExposureModel& model, double time_s, int row, int rows);

/// The settings of the left camera, frame by frame. A setting depends on what was observed `lag_frames` or
/// more before and on nothing else.
class ExposureControl {
 public:
  explicit ExposureControl(const ExposureModel& model);

  /// For the next frame.
  ExposureSetting next();
  /// The mean grey value above black of the delivered left image; once after every next().
  void observe(double mean_grey);

 private:
  ExposureSetting decided(const ExposureSetting& taken, double mean_grey) const;

  const ExposureModel model_;
  std::deque<ExposureSetting> coming_;  ///< decided for the next frames
  ExposureSetting taken_;               ///< of the frame to be observed
};

}  // namespace groundloop::sim
