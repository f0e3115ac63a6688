// Recordings of raw images that come with a stereo calibration in OpenCV's YAML.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "slam/rectify/rectifier.h"
#include "slam/source/euroc_source.h"
#include "slam/source/kitti_source.h"
#include "slam/types/config.h"
#include "tests/slam/source/temporary_folder.h"

namespace groundloop::slam {
namespace {

class RawRecording : public testing::Test {
 protected:
  RawRecording() {
    for (int i = 0; i < 2; ++i) {
      for (cv::Mat& image : raw_[i]) {
        image.create(48, 64, CV_8UC1);
        cv::randu(image, 0, 256);
      }
    }
    folder_.write("stereo.yml",
                  "%YAML:1.0\n---\n"
                  "M1: {rows: 3, cols: 3, dt: d, data: [60, 0, 30, 0, 61, 25, 0, 0, 1]}\n"
                  "M2: {rows: 3, cols: 3, dt: d, data: [62, 0, 33, 0, 60, 23, 0, 0, 1]}\n"
                  "D1: {rows: 1, cols: 4, dt: d, data: [-0.1, 0.02, 0.001, 0]}\n"
                  "D2: {rows: 1, cols: 4, dt: d, data: [-0.12, 0.01, 0, 0.001]}\n"
                  "R: {rows: 3, cols: 3, dt: d, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n"
                  "T: {rows: 3, cols: 1, dt: d, data: [-0.1, 0, 0]}\n");
    options_.calibration_files = {folder_.path() + "/stereo.yml"};
  }

  void write_image(const std::string& name, const cv::Mat& image) {
    const std::filesystem::path file = folder_.path() + "/" + name;
    std::filesystem::create_directories(file.parent_path());
    cv::imwrite(file.string(), image);
  }

  /// Every pair is what the calibration makes of the raw one.
  void expect_rectified(StereoSource& source) {
    const Rectifier rectifier(read_stereo_calibration(options_.calibration_files), {64, 48});
    EXPECT_NEAR(source.rig().baseline_m, 0.1, 1e-9);
    EXPECT_EQ(source.rig().fx_px, rectifier.rig().fx_px);
    EXPECT_DOUBLE_EQ(source.rig().T_body_left.translation().z(), options_.camera_height_m);
    for (const auto& raw : raw_) {
      const auto frame = source.next();
      ASSERT_TRUE(frame);
      cv::Mat left, right;
      rectifier.rectify(raw[0], raw[1], left, right);
      EXPECT_EQ(cv::norm(frame->left, left, cv::NORM_INF), 0);
      EXPECT_EQ(cv::norm(frame->right, right, cv::NORM_INF), 0);
    }
    EXPECT_FALSE(source.next());
  }

  TemporaryFolder folder_;
  cv::Mat raw_[2][2];  ///< by pair: left, right
  SourceOptions options_;
};

TEST_F(RawRecording, InKittisLayoutNeedsNoCalibTxt) {
  folder_.write("times.txt", "0.0\n0.1\n");
  for (int i = 0; i < 2; ++i) {
    for (int camera = 0; camera < 2; ++camera) {
      write_image("image_" + std::to_string(camera) + "/00000" + std::to_string(i) + ".png", raw_[i][camera]);
    }
  }
  KittiSource source(folder_.path(), options_);
  expect_rectified(source);
}

TEST_F(RawRecording, InEurocsLayoutNeedsNoSensorYaml) {
  for (int camera = 0; camera < 2; ++camera) {
    const std::string cam = "cam" + std::to_string(camera);
    folder_.write(cam + "/data.csv", "1000,0.png\n2000,1.png\n");
    for (int i = 0; i < 2; ++i) write_image(cam + "/data/" + std::to_string(i) + ".png", raw_[i][camera]);
  }
  EurocSource source(folder_.path(), options_);
  expect_rectified(source);
}

TEST_F(RawRecording, AMissingCalibrationIsNamed) {
  options_.calibration_files = {folder_.path() + "/none.yml"};
  folder_.write("times.txt", "0.0\n");
  try {
    KittiSource source(folder_.path(), options_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("none.yml: cannot be read: wanted a stereo calibration"));
  }
}

}  // namespace
}  // namespace groundloop::slam
