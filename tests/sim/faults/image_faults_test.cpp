#include "sim/faults/image_faults.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace groundloop::sim {
namespace {

Fault from(double at_s, double for_s) {
  Fault fault;
  fault.at_s = at_s;
  fault.for_s = for_s;
  return fault;
}

/// An even image after the faults of a time.
cv::Mat struck(const std::vector<Fault>& faults, int camera, double time_s, int grey = 100,
               uint64_t seed = 1) {
  cv::Mat image(120, 160, CV_8UC1, cv::Scalar(grey));
  apply_image_faults(faults, seed, camera, time_s, image);
  return image;
}
int grey_of(const cv::Mat& image) {
  double low = 0, high = 0;
  cv::minMaxLoc(image, &low, &high);
  EXPECT_EQ(low, high) << "the image is even";
  return static_cast<int>(low);
}
bool same(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0; }

TEST(ImageFaults, ExposureScalesAndSaturates) {
  Fault fault = from(1, 2);
  fault.exposure = ExposureFault{1.5, FaultCamera::kLeft};
  EXPECT_EQ(grey_of(struck({fault}, 0, 0.9)), 100);
  EXPECT_EQ(grey_of(struck({fault}, 0, 1)), 150);
  EXPECT_EQ(grey_of(struck({fault}, 1, 1)), 100) << "the right camera is not struck";
  EXPECT_EQ(grey_of(struck({fault}, 0, 3)), 100);
  EXPECT_EQ(grey_of(struck({fault, fault}, 0, 1, 200)), 255);
}

TEST(ImageFaults, AFlashFadesInAStraightLine) {
  Fault fault = from(1, 2);
  fault.flash = FlashFault{3};
  EXPECT_EQ(grey_of(struck({fault}, 0, 1, 50)), 150);
  EXPECT_EQ(grey_of(struck({fault}, 1, 2, 50)), 100);
  EXPECT_EQ(grey_of(struck({fault}, 1, 2.5, 50)), 75);
  EXPECT_EQ(grey_of(struck({fault}, 0, 3, 50)), 50);
}

TEST(ImageFaults, ABlackoutLeavesNoLight) {
  Fault fault = from(0, 1), bright = from(0, 1);
  fault.blackout = BlackoutFault{FaultCamera::kRight};
  bright.exposure = ExposureFault{100};
  EXPECT_EQ(grey_of(struck({fault, bright}, 1, 0)), 0);
  EXPECT_EQ(grey_of(struck({fault, bright}, 0, 0)), 255);
}

TEST(ImageFaults, BlurHasTheSigmaItSays) {
  Fault fault = from(0, 1);
  fault.blur = BlurFault{3};
  cv::Mat step(120, 160, CV_8UC1, cv::Scalar(0));
  step.colRange(80, 160).setTo(200);
  apply_image_faults({fault}, 1, 0, 0, step);
  for (int u = 70; u < 90; ++u) {
    const double expected = 200 * 0.5 * std::erfc(-(u - 79.5) / (3 * std::sqrt(2.0)));
    EXPECT_NEAR(step.at<uchar>(60, u), expected, 1.5) << u;
  }
}

TEST(ImageFaults, DirtStaysWhereItIsAndIsOnOneLens) {
  Fault fault = from(1, 10);
  fault.dirt = DirtFault{FaultCamera::kLeft, 5, 12, 0.7};
  const cv::Mat dirty = struck({fault}, 0, 1);
  EXPECT_TRUE(same(dirty, struck({fault}, 0, 7.3)));
  EXPECT_FALSE(same(dirty, struck({fault}, 0, 1, 100, 2))) << "the seed places it";
  EXPECT_EQ(grey_of(struck({fault}, 1, 1)), 100);

  double low = 0, high = 0;
  cv::minMaxLoc(dirty, &low, &high);
  EXPECT_EQ(high, 100) << "clean glass between the spots";
  EXPECT_LE(low, 31) << "a spot's middle keeps 70 % away";
  const int darkened = cv::countNonZero(dirty < 100);
  EXPECT_GT(darkened, 5 * 3.14 * 6 * 6 / 4);
  EXPECT_LT(darkened, 5 * 3.15 * 18 * 18);
}

/// Light has no upper end, and what is told in delivered pixels is larger on a sensor that is binned.
TEST(ImageFaults, LightOnASensorIsStruckAlike) {
  Fault dirty = from(0, 1), bright = from(0, 1);
  dirty.dirt = DirtFault{FaultCamera::kLeft, 5, 12, 0.7};
  bright.exposure = ExposureFault{4};
  cv::Mat light(120, 160, CV_32FC1, cv::Scalar(100));
  apply_image_faults({dirty}, 1, 0, 0, light);
  cv::Mat grey;
  light.convertTo(grey, CV_8U);
  EXPECT_LE(cv::norm(grey, struck({dirty}, 0, 0), cv::NORM_INF), 1);
  cv::Mat fine(240, 320, CV_32FC1, cv::Scalar(100));
  apply_image_faults({dirty}, 1, 0, 0, fine, 2);
  EXPECT_NEAR(cv::countNonZero(fine < 99) / 4.0, cv::countNonZero(light < 99), 20);
  cv::Mat even(4, 4, CV_32FC1, cv::Scalar(100));
  apply_image_faults({bright}, 1, 0, 0, even);
  EXPECT_EQ(even.at<float>(2, 2), 400);
}

TEST(ImageFaults, DirtOfBothLensesDiffers) {
  Fault fault = from(0, 1);
  fault.dirt = DirtFault{FaultCamera::kBoth, 5, 12, 0.7};
  EXPECT_FALSE(same(struck({fault}, 0, 0), struck({fault}, 1, 0)));
}

}  // namespace
}  // namespace groundloop::sim
