#include "sim/head/photon_transfer.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "sim/head/sensor.h"

namespace groundloop::sim {
namespace {

const cv::Size kSize(400, 300);

/// A sensor before an evenly lit wall, at one setting; every call is a new frame.
class Bench {
 public:
  Bench(const SensorModel& model, const ExposureSetting& setting, int camera)
      : model_(model), setting_(setting), sensor_(model, kSize, camera) {}

  /// Frames with a mean of so many grey levels above black.
  FlatField field(double light_dn, int frames) {
    const double gain = model_.gain_dn_per_e * std::pow(10, setting_.gain_db / 20);
    const double electrons = light_dn / gain;
    const double level =
        255 * electrons / (model_.white_photons_per_s * setting_.time_s * model_.quantum_efficiency);
    FlatField field(static_cast<size_t>(frames));
    for (cv::Mat& image : field) {
      sensor_.read_out(cv::Mat(kSize, CV_32FC1, cv::Scalar(level)), setting_, 11, frame_++, image);
    }
    return field;
  }

 private:
  SensorModel model_;
  ExposureSetting setting_;
  Sensor sensor_;
  int64_t frame_ = 0;
};

struct Case {
  int64_t serial;
  int camera;
  double gain_dn_per_e, gain_db, read_noise_e, prnu_percent, full_well_e;
};

class PhotonTransferOf : public testing::TestWithParam<Case> {};

/// The experiment of EMVA 1288 with our own images finds what the sensor was told to be, to 3 %.
TEST_P(PhotonTransferOf, FindsTheSensorAgain) {
  const Case& c = GetParam();
  SensorModel model;
  model.serial = c.serial;
  model.gain_dn_per_e = c.gain_dn_per_e;
  model.read_noise_e = c.read_noise_e;
  model.prnu_percent = c.prnu_percent;
  model.full_well_e = c.full_well_e;
  model.black_dn = 16;
  Bench bench(model, {0.002, c.gain_db}, c.camera);
  std::vector<FlatField> others;
  for (double light_dn = 0.25; light_dn <= 3; light_dn += 0.25) others.push_back(bench.field(light_dn, 2));
  for (const double light_dn : {10.0, 25.0, 60.0, 90.0, 150.0}) others.push_back(bench.field(light_dn, 2));
  const PhotonTransfer found = photon_transfer(bench.field(0, 12), bench.field(110, 12), others);

  const double gain = c.gain_dn_per_e * std::pow(10, c.gain_db / 20);
  EXPECT_NEAR(found.gain_dn_per_e, gain, 0.03 * gain);
  EXPECT_NEAR(found.read_noise_e, c.read_noise_e, 0.03 * c.read_noise_e);
  EXPECT_NEAR(found.prnu_percent, c.prnu_percent, 0.03 * c.prnu_percent);
  EXPECT_NEAR(found.black_dn, 16, 0.05);
}

INSTANTIATE_TEST_SUITE_P(PhotonTransfer, PhotonTransferOf,
                         testing::Values(Case{20318, 0, 0.0085, 12, 24, 0.8, 30000},
                                         Case{7, 1, 0.05, 0, 20, 1.5, 4600},
                                         Case{20318, 1, 0.0085, 12, 12, 0.8, 30000},
                                         Case{991, 0, 0.2, 0, 4, 2.5, 1200},
                                         Case{12345678, 1, 0.02, 6, 15, 0.6, 12000}));

TEST(PhotonTransfer, RefusesWhatSaysNothing) {
  SensorModel model;
  Bench bench(model, {0.002, 0}, 0);
  const FlatField dark = bench.field(0, 2), single = bench.field(100, 1);
  EXPECT_THROW(photon_transfer(dark, single, {}), std::invalid_argument);
  EXPECT_THROW(photon_transfer(bench.field(100, 2), dark, {}), std::invalid_argument);
}

}  // namespace
}  // namespace groundloop::sim
