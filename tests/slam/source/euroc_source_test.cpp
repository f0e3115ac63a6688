#include "slam/source/euroc_source.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "slam/types/config.h"
#include "tests/slam/source/temporary_folder.h"

namespace groundloop::slam {
namespace {

/// A raw camera as a EuRoC folder describes it.
struct RawCamera {
  Pose T_vehicle_camera = Pose::Identity();
  std::vector<double> intrinsics;
  std::vector<double> distortion;

  std::string yaml() const {
    const Eigen::Matrix4d T = T_vehicle_camera.matrix();
    std::string numbers;
    for (int i = 0; i < 16; ++i) numbers += fmt::format("{}{}", i == 0 ? "" : ", ", T(i / 4, i % 4));
    return fmt::format(
        "# General sensor definitions.\nsensor_type: camera\ncomment: made by a test\nT_BS:\n  cols: 4\n  "
        "rows: 4\n"
        "  data: [{}]\nrate_hz: 20\nresolution: [376, 240]\ncamera_model: pinhole\nintrinsics: [{}]\n"
        "distortion_model: radial-tangential\ndistortion_coefficients: [{}]\n",
        numbers, fmt::join(intrinsics, ", "), fmt::join(distortion, ", "));
  }

  /// A round blob at the distorted projection of the point.
  cv::Mat image_of(const Eigen::Vector3d& p_vehicle) const {
    const Eigen::Vector3d p = T_vehicle_camera.inverse() * p_vehicle;
    std::vector<cv::Point2d> uv;
    const cv::Matx33d K(intrinsics[0], 0, intrinsics[2], 0, intrinsics[1], intrinsics[3], 0, 0, 1);
    cv::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, cv::Vec3d(), cv::Vec3d(), K,
                      distortion, uv);
    cv::Mat image(240, 376, CV_8UC1);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const double d2 = std::pow(u - uv[0].x, 2) + std::pow(v - uv[0].y, 2);
        image.at<uint8_t>(v, u) = static_cast<uint8_t>(std::lround(250 * std::exp(-d2 / 18)));
      }
    }
    return image;
  }
};

RawCamera left_camera() {
  RawCamera camera;
  camera.T_vehicle_camera = se3_exp((Vector6d() << 0.02, -0.06, 0.01, 0.3, -0.2, 1.4).finished());
  camera.intrinsics = {229.3, 228.6, 183.6, 124.2};
  camera.distortion = {-0.2834, 0.0739, 0.00019, 0.0000176};
  return camera;
}
RawCamera right_camera() {
  RawCamera camera = left_camera();
  camera.T_vehicle_camera =
      camera.T_vehicle_camera * se3_exp((Vector6d() << 0.11, 0.001, -0.002, 0.01, -0.015, 0.02).finished());
  camera.intrinsics = {228.1, 227.9, 189.9, 127.6};
  camera.distortion = {-0.2837, 0.0745, -0.0001, -0.0000356};
  return camera;
}

constexpr int64_t kFirst_ns = 1403715273262142976;

std::vector<Eigen::Vector3d> points_in_left() {
  return {{0, 0, 1.5}, {-0.7, 0.4, 1.8}, {0.9, -0.5, 2.2}, {0.5, 0.6, 1.6}, {-1.2, -0.6, 2.5}};
}

/// One pair a point; cam1 lacks the second stamp and has one of its own.
void write_sequence(const TemporaryFolder& folder, const std::string& base = "mav0/") {
  folder.write(base + "cam0/sensor.yaml", left_camera().yaml());
  folder.write(base + "cam1/sensor.yaml", right_camera().yaml());
  std::string left_csv = "#timestamp [ns],filename\r\n", right_csv = left_csv;
  int64_t stamp_ns = kFirst_ns;
  for (size_t i = 0; i < points_in_left().size(); ++i, stamp_ns += 50000000) {
    const Eigen::Vector3d p_vehicle = left_camera().T_vehicle_camera * points_in_left()[i];
    left_csv += fmt::format("{0},{0}.png\r\n", stamp_ns);
    right_csv += fmt::format("{0},{0}.png\r\n", i == 1 ? stamp_ns + 1 : stamp_ns);
    for (const char* camera : {"cam0", "cam1"}) {
      std::filesystem::create_directories(folder.path(base + camera + "/data"));
      const RawCamera raw = camera == std::string("cam0") ? left_camera() : right_camera();
      cv::imwrite(folder.path(fmt::format("{}{}/data/{}.png", base, camera, stamp_ns)),
                  raw.image_of(p_vehicle));
    }
  }
  folder.write(base + "cam0/data.csv", left_csv);
  folder.write(base + "cam1/data.csv", right_csv);
}

Eigen::Vector2d centroid(const cv::Mat& image) {
  const cv::Moments m = cv::moments(image);
  return {m.m10 / m.m00, m.m01 / m.m00};
}

std::vector<std::string> messages_of_opening(const TemporaryFolder& folder) {
  std::vector<std::string> lines;
  try {
    EurocSource source(folder.path());
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems())
      lines.push_back(problem.text().substr(folder.path().size() + 1));
  }
  return lines;
}
using Lines = std::vector<std::string>;

TEST(EurocSource, RectifiedPairsTriangulateToTheTruePoints) {
  const TemporaryFolder folder;
  write_sequence(folder);
  EurocSource source(folder.path());
  const StereoRig& rig = source.rig();
  EXPECT_NEAR(rig.baseline_m, std::sqrt(0.11 * 0.11 + 0.001 * 0.001 + 0.002 * 0.002), 1e-3);
  std::vector<Eigen::Vector3d> truth = points_in_left(), found;
  truth.erase(truth.begin() + 1);
  while (const auto frame = source.next()) {
    EXPECT_EQ(frame->left.type(), CV_8UC1);
    EXPECT_EQ(frame->left.size(), cv::Size(376, 240));
    const Eigen::Vector2d left = centroid(frame->left), right = centroid(frame->right);
    EXPECT_NEAR(left.y(), right.y(), 0.1) << "rows of a rectified pair agree";
    found.push_back(*rig.triangulate({left.x(), 0.5 * (left.y() + right.y()), right.x()}));
  }
  ASSERT_EQ(found.size(), truth.size());
  // Rectification turns the camera, so distances to it and between points are what must agree.
  for (size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(found[i].norm(), truth[i].norm(), 0.02 * truth[i].norm());
    for (size_t j = 0; j < i; ++j)
      EXPECT_NEAR((found[i] - found[j]).norm(), (truth[i] - truth[j]).norm(), 0.04);
  }
}

TEST(EurocSource, TakesTheStampsThatBothCamerasHave) {
  const TemporaryFolder folder;
  write_sequence(folder);
  EurocSource source(folder.path() + "/mav0", {.camera_height_m = 0.5});
  EXPECT_EQ(source.size(), 4);
  EXPECT_EQ(source.stamps_ns(), (std::vector<int64_t>{kFirst_ns, kFirst_ns + 100000000, kFirst_ns + 150000000,
                                                      kFirst_ns + 200000000}));
  EXPECT_EQ(source.rig().T_body_left.translation().z(), 0.5);
  EXPECT_EQ(source.next()->stamp_ns, kFirst_ns);
  const auto second = source.next();
  EXPECT_EQ(second->index, 1);
  EXPECT_EQ(second->stamp_ns, kFirst_ns + 100000000);
}

TEST(EurocSource, NamesEverythingThatIsMissingAtOnce) {
  const TemporaryFolder folder;
  EXPECT_EQ(messages_of_opening(folder),
            (Lines{"cam0/sensor.yaml: no such file: wanted a YAML file that can be read",
                   "cam1/sensor.yaml: no such file: wanted a YAML file that can be read",
                   "cam0/data.csv: no such file: wanted lines of stamp in ns and file name",
                   "cam1/data.csv: no such file: wanted lines of stamp in ns and file name"}));
}

TEST(EurocSource, NamesTheWrongValuesOfACamera) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("mav0/cam1/sensor.yaml",
               "T_BS:\n  data: [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nresolution: [376]\n"
               "camera_model: omni\nintrinsics: [0, 1, 2, 3]\ndistortion_model: equidistant\n");
  const Lines lines = messages_of_opening(folder);
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_THAT(
      lines[0],
      testing::AllOf(testing::StartsWith("mav0/cam1/sensor.yaml:2: T_BS.data: "),
                     testing::EndsWith("wanted a rigid motion: rotation and translation over 0, 0, 0, 1")));
  EXPECT_EQ(lines[1], "mav0/cam1/sensor.yaml:1: distortion_coefficients: missing: wanted a list");
  EXPECT_EQ(lines[2], "mav0/cam1/sensor.yaml:3: resolution: [376]: wanted width and height in pixels");
  EXPECT_EQ(lines[3], "mav0/cam1/sensor.yaml:4: camera_model: omni: wanted pinhole");
  EXPECT_EQ(lines[4],
            "mav0/cam1/sensor.yaml:5: intrinsics: [0, 1, 2, 3]: wanted fx, fy, cx, cy in pixels, fx and fy "
            "above 0");
  EXPECT_EQ(lines[5], "mav0/cam1/sensor.yaml:6: distortion_model: equidistant: wanted radial-tangential");
}

TEST(EurocSource, NamesTheWrongLineOfTheStamps) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("mav0/cam0/data.csv", "#timestamp [ns],filename\n1.5,a.png\n20\n");
  EXPECT_EQ(messages_of_opening(folder),
            (Lines{"mav0/cam0/data.csv:2: 1.5,a.png: wanted stamp in ns, file name",
                   "mav0/cam0/data.csv:3: 20: wanted stamp in ns, file name"}));
  folder.write("mav0/cam0/data.csv", "7,a.png\n");
  EXPECT_EQ(messages_of_opening(folder),
            Lines{"mav0/cam1/data.csv: no stamp of cam0: wanted stamps that both cameras have"});
}

TEST(EurocSource, RefusesCamerasInTheWrongOrder) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("mav0/cam0/sensor.yaml", right_camera().yaml());
  folder.write("mav0/cam1/sensor.yaml", left_camera().yaml());
  ASSERT_EQ(messages_of_opening(folder).size(), 1U);
  EXPECT_THAT(messages_of_opening(folder)[0],
              testing::EndsWith("wanted a camera to the right of the left one"));
}

}  // namespace
}  // namespace groundloop::slam
