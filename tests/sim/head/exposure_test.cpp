#include "sim/head/exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace groundloop::sim {
namespace {

ExposureModel rolling() {
  ExposureModel model;
  model.time_s = 0.004;
  model.readout_s = 0.020;
  model.sub_frames = 6;
  return model;
}

TEST(Shutter, SubFramesAreEvenlyOverTheSpanAboutTheStamp) {
  const std::vector<double> times_s = rolling().sub_frame_times_s();
  ASSERT_EQ(times_s.size(), 6U);
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(times_s[i], -0.010 + 0.004 * static_cast<double>(i), 1e-12);
  EXPECT_EQ(ExposureModel{}.sub_frame_times_s(), std::vector<double>{0});
}

/// Weighted by the rows' weights, the sub-frames' times are on average the middle of the row's exposure.
TEST(Shutter, EveryRowHasItsOwnExposure) {
  const ExposureModel model = rolling();
  const std::vector<double> times_s = model.sub_frame_times_s();
  for (const int row : {0, 100, 239, 240, 479}) {
    const std::vector<float> weights = shutter_weights(model, 0.004, row, 480);
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0F), 1, 1e-6);
    double mean_s = 0;
    for (size_t i = 0; i < 6; ++i) mean_s += weights[i] * times_s[i];
    EXPECT_NEAR(mean_s, 0.020 * ((row + 0.5) / 480 - 0.5), 1e-9) << row;  // exposure = part: exact
  }
  // 1 ms, wholly within the first part of the span
  EXPECT_EQ(shutter_weights(model, 0.001, 0, 480), (std::vector<float>{1, 0, 0, 0, 0, 0}));
}

TEST(Shutter, AGlobalOneTakesAllRowsAlikeAndItsPartOfALongerSpan) {
  ExposureModel model;
  model.sub_frames = 4;
  model.automatic = AutoExposureModel{.max_time_s = 0.016};
  EXPECT_DOUBLE_EQ(model.longest_s(), 0.016);
  for (const int row : {0, 479}) {
    EXPECT_EQ(shutter_weights(model, 0.016, row, 480), (std::vector<float>{0.25, 0.25, 0.25, 0.25}));
    EXPECT_EQ(shutter_weights(model, 0.008, row, 480), (std::vector<float>{0, 0.5, 0.5, 0}));
  }
  model.right_time_factor = 1.5;
  EXPECT_DOUBLE_EQ(model.longest_s(), 0.024);
  const ExposureSetting right = right_setting(model, {0.008, 6});
  EXPECT_DOUBLE_EQ(right.time_s, 0.012);
  EXPECT_DOUBLE_EQ(right.gain_db, 6);
}

TEST(AutoExposure, FixedSettingsStay) {
  ExposureModel model;
  model.gain_db = 3;
  ExposureControl control(model);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(control.next(), (ExposureSetting{0.008, 3}));
    control.observe(10);
  }
}

/// Before a linear sensor the error in stops shrinks by the speed with each decision.
TEST(AutoExposure, ConvergesAsItsLawSaysAfterItsLag) {
  ExposureModel model;
  model.time_s = 0.001;
  model.automatic = AutoExposureModel{.target_grey = 100, .lag_frames = 3, .speed = 0.5, .max_time_s = 0.1};
  ExposureControl control(model);
  const double grey_per_s = 25 / 0.001;  // 2 stops too dark
  double stops = 2;
  for (int frame = 0; frame < 12; ++frame) {
    const ExposureSetting setting = control.next();
    if (frame > 0 && frame % 3 == 0) stops *= 0.5;
    EXPECT_NEAR(std::log2(100 / (grey_per_s * setting.time_s)), stops, 1e-9) << frame;
    EXPECT_EQ(setting.gain_db, 0);
    control.observe(grey_per_s * setting.time_s);
  }
}

TEST(AutoExposure, RaisesTheGainOnceTheTimeIsAtItsLongest) {
  ExposureModel model;
  model.time_s = 0.010;
  model.gain_db = 0;
  model.automatic = AutoExposureModel{
      .target_grey = 100, .lag_frames = 1, .speed = 1, .max_time_s = 0.020, .max_gain_db = 12};
  ExposureControl control(model);
  control.next();
  control.observe(25);  // four times as much: twice by time, twice by gain
  const ExposureSetting setting = control.next();
  EXPECT_DOUBLE_EQ(setting.time_s, 0.020);
  EXPECT_NEAR(setting.gain_db, 20 * std::log10(2), 1e-9);
  control.observe(0);  // black: as far as it goes
  EXPECT_NEAR(control.next().gain_db, 12, 1e-9);
  control.observe(255 * 1000);
  EXPECT_NEAR(control.next().time_s, 0.0005, 1e-12);
}

}  // namespace
}  // namespace groundloop::sim
