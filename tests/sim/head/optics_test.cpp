#include "sim/head/optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace groundloop::sim {
namespace {

using Eigen::Vector2d;

constexpr int kWidth = 160, kHeight = 120;

Optics plain(double supersampling) {
  Optics optics;
  optics.left = optics.right = {.fx_px = 140, .fy_px = 140, .cx_px = 79.5, .cy_px = 59.5};
  optics.vignetting = {.cosine_power = 0};
  optics.supersampling = supersampling;
  return optics;
}

ReadPixels pixels(Reduction reduction = Reduction::kNone, Mosaic mosaic = Mosaic::kNone) {
  return {read_pixels(kWidth, reduction, 2, mosaic), read_pixels(kHeight, reduction, 2, mosaic), mosaic};
}

/// A rendered image whose grey value is a function of the direction.
template <class Grey>
cv::Mat rendered(const RenderView& view, const Grey& grey) {
  cv::Mat image(view.size, CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      image.at<uchar>(v, u) = cv::saturate_cast<uchar>(
          grey(Vector2d((u - view.cx_px) / view.focal_px, (v - view.cy_px) / view.focal_px)));
    }
  }
  return image;
}

struct Image {
  cv::Mat level;
  RenderView view;
};
template <class Grey>
Image seen(const Optics& optics, const ReadPixels& read, const Grey& grey, int camera = 0) {
  Image image;
  image.view = render_view(optics, read);
  LensImage(optics, camera, read, image.view).expose(rendered(image.view, grey), image.level);
  return image;
}

/// Centre, and variance along x and y, of a bright spot.
struct Spot {
  Vector2d centre, variance;
};
Spot spot_of(const cv::Mat& level) {
  const cv::Moments m = cv::moments(level);
  return {{m.m10 / m.m00, m.m01 / m.m00}, {m.mu20 / m.m00, m.mu02 / m.m00}};
}

auto spot_at(const Vector2d& xy, double sigma) {
  return [=](const Vector2d& p) { return 250 * std::exp(-(p - xy).squaredNorm() / (2 * sigma * sigma)); };
}

TEST(Optics, SpotsLieWhereTheLensPutsThem) {
  Optics optics = plain(2);
  optics.left = {.fx_px = 141,
                 .fy_px = 137,
                 .cx_px = 71,
                 .cy_px = 66,
                 .k1 = -0.2,
                 .k2 = 0.08,
                 .p1 = 0.002,
                 .p2 = -0.003,
                 .k3 = 0.01};
  optics.right = {.fx_px = 139, .fy_px = 142, .cx_px = 85, .cy_px = 55, .k1 = -0.17, .k2 = 0.05};
  for (const int camera : {0, 1}) {
    for (const Vector2d& xy :
         {Vector2d(0, 0), Vector2d(-0.35, 0.25), Vector2d(0.4, -0.3), Vector2d(0.2, 0.3)}) {
      const Spot spot = spot_of(seen(optics, pixels(), spot_at(xy, 0.01), camera).level);
      const Vector2d expected = optics.lens(camera).pixel(xy);
      // a spot of 1.4 px is pulled a little by the distortion's curvature
      EXPECT_LT((spot.centre - expected).norm(), 0.02) << camera << ": " << xy.transpose();
    }
  }
}

TEST(Optics, WithoutDistortionTwiceTheResolutionIsAveragedByFours) {
  const Optics optics = plain(2);
  const RenderView view = render_view(optics, pixels());
  cv::Mat image(view.size, CV_8UC1), level;
  cv::randu(image, 0, 256);
  LensImage(optics, 0, pixels(), view).expose(image, level);
  // delivered pixel 0 begins at direction (-0.5 - cx) / f, where rendered pixels begin, too
  const double left = (-0.5 - 79.5) / 140 * view.focal_px + view.cx_px + 0.5;
  const double top = (-0.5 - 59.5) / 140 * view.focal_px + view.cy_px + 0.5;
  const int u0 = cvRound(left), v0 = cvRound(top);
  ASSERT_NEAR(left, u0, 1e-9);
  ASSERT_NEAR(top, v0, 1e-9);
  for (const auto& [u, v] : {std::pair(0, 0), std::pair(159, 119), std::pair(37, 81)}) {
    EXPECT_NEAR(level.at<float>(v, u), cv::mean(image(cv::Rect(u0 + 2 * u, v0 + 2 * v, 2, 2)))[0], 0.02);
  }
}

TEST(Optics, BlurAndDefocusWidenASpotByTheirOwnVariance) {
  const auto spot = spot_at({0.1, -0.05}, 0.012);
  const Spot sharp = spot_of(seen(plain(2), pixels(), spot).level);
  Optics blurred = plain(2);
  blurred.blur_px = 1.3;
  Optics defocused = plain(2);
  defocused.defocus_px = 2.4;
  for (const auto& [optics, variance] :
       {std::pair(blurred, 1.3 * 1.3), std::pair(defocused, 2.4 * 2.4 / 4)}) {
    const Spot wide = spot_of(seen(optics, pixels(), spot).level);
    EXPECT_LT((wide.centre - sharp.centre).norm(), 0.01);
    // 8-bit rounding cuts off the tails
    EXPECT_NEAR(wide.variance.x() - sharp.variance.x(), variance, 0.04 * variance);
    EXPECT_NEAR(wide.variance.y() - sharp.variance.y(), variance, 0.04 * variance);
  }
}

TEST(Optics, DiskHasItsRadius) {
  const cv::Mat disk = disk_kernel(3.5);
  EXPECT_EQ(disk.rows, 9);
  EXPECT_NEAR(cv::sum(disk)[0], 1, 1e-6);
  EXPECT_NEAR(1 / disk.at<float>(4, 4), M_PI * 3.5 * 3.5, 0.1);
  EXPECT_EQ(disk.at<float>(0, 0), 0);
}

TEST(Optics, VignettingFollowsItsLaw) {
  Optics optics = plain(1);
  optics.vignetting = {.cosine_power = 4, .a2 = -0.2, .a4 = 0.05};
  const cv::Mat level = seen(optics, pixels(), [](const Vector2d&) { return 200; }).level;
  for (const auto& [u, v] : {std::pair(79, 59), std::pair(0, 0), std::pair(150, 20)}) {
    const double x = (u - 79.5) / 140, y = (v - 59.5) / 140;
    const double r2 = (std::pow(u - 79.5, 2) + std::pow(v - 59.5, 2)) / (80.0 * 80 + 60 * 60);
    const double law = std::pow(1 + x * x + y * y, -2) * (1 - 0.2 * r2 + 0.05 * r2 * r2);
    EXPECT_NEAR(level.at<float>(v, u), 200 * law, 0.01) << u << " " << v;
  }
}

/// Stripes of one sensor pixel each: decimation sees one of the two, binning the mean of both.
TEST(Optics, DecimationAliasesAndBinningAverages) {
  const auto stripes = [](const Vector2d& p) {
    const double sensor_column = std::floor((p.x() * 140 + 79.5) * 2 + 0.5);
    return static_cast<int>(sensor_column) % 2 == 0 ? 240 : 40;
  };
  const cv::Mat decimated = seen(plain(4), pixels(Reduction::kDecimation), stripes).level;
  EXPECT_EQ(decimated.size(), cv::Size(kWidth, kHeight));
  EXPECT_NEAR(decimated.at<float>(60, 80), 240, 0.5);
  EXPECT_NEAR(decimated.at<float>(7, 21), 240, 0.5);
  const cv::Mat all =
      seen(plain(4), pixels(Reduction::kBinning), [&stripes](const Vector2d& p) {
        return stripes(p + Vector2d(0.25 / 140, 0));  // binned columns begin a quarter to the left
      }).level;
  EXPECT_EQ(all.size(), cv::Size(2 * kWidth, 2 * kHeight));
  EXPECT_NEAR(all.at<float>(60, 80), 240, 0.5);
  EXPECT_NEAR(all.at<float>(60, 81), 40, 0.5);
}

TEST(Optics, BehindAMosaicEachPixelSeesItsColour) {
  const ReadPixels read = pixels(Reduction::kDecimation, Mosaic::kGrbg);
  const RenderView view = render_view(plain(1), read);
  const cv::Mat image(view.size, CV_8UC3, cv::Scalar(20, 90, 200));
  cv::Mat level;
  LensImage(plain(1), 0, read, view).expose(image, level);
  EXPECT_EQ(level.at<float>(10, 20), 90);
  EXPECT_EQ(level.at<float>(10, 21), 200);
  EXPECT_EQ(level.at<float>(11, 20), 20);
  EXPECT_EQ(level.at<float>(11, 21), 90);
}

TEST(Optics, ALensThatFoldsOverIsRefused) {
  Optics optics = plain(1);
  optics.right.k1 = -1.5;
  EXPECT_THROW(render_view(optics, pixels()), std::domain_error);
}

TEST(PixelGrid, EveryReductionReadsWhereItSays) {
  const auto centres = [](const std::vector<Extent>& extents) {
    std::vector<double> all;
    for (const Extent& e : extents) all.push_back(0.5 * (e.from + e.to));
    return all;
  };
  using Centres = std::vector<double>;
  EXPECT_EQ(centres(read_pixels(4, Reduction::kNone, 2, Mosaic::kNone)), (Centres{0, 1, 2, 3}));
  EXPECT_EQ(centres(read_pixels(4, Reduction::kNone, 2, Mosaic::kRggb)), (Centres{0, 1, 2, 3}));
  EXPECT_EQ(centres(read_pixels(3, Reduction::kDecimation, 2, Mosaic::kNone)), (Centres{0, 1, 2}));
  EXPECT_EQ(centres(read_pixels(2, Reduction::kBinning, 2, Mosaic::kNone)),
            (Centres{-0.25, 0.25, 0.75, 1.25}));
  // sensor columns 0, 1, 4, 5 of a mosaic
  EXPECT_EQ(centres(read_pixels(4, Reduction::kDecimation, 2, Mosaic::kRggb)),
            (Centres{0.25, 0.75, 2.25, 2.75}));
  for (const Extent& e : read_pixels(4, Reduction::kDecimation, 4, Mosaic::kNone))
    EXPECT_EQ(e.to - e.from, 0.25);
}

}  // namespace
}  // namespace groundloop::sim
