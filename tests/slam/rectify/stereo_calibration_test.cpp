#include "slam/rectify/stereo_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "slam/types/config.h"

namespace groundloop::slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const cv::Matx33d kM1(500, 0, 310, 0, 505, 245, 0, 0, 1), kM2(498, 0, 322, 0, 502, 238, 0, 0, 1);
const cv::Mat kD1 = (cv::Mat_<double>(1, 5) << -0.2, 0.1, 1e-3, -2e-3, 0.01);
const cv::Mat kD2 = (cv::Mat_<double>(1, 4) << -0.21, 0.11, 0, 0);
const cv::Vec3d kT(-0.0881, 0.0004, -0.0003);

cv::Matx33d rotation() {
  cv::Matx33d R;
  cv::Rodrigues(cv::Vec3d(0.01, -0.02, 0.005), R);
  return R;
}

void write_intrinsics(cv::FileStorage& file) {
  file << "M1" << cv::Mat(kM1) << "D1" << kD1 << "M2" << cv::Mat(kM2) << "D2" << kD2;
}
void write_extrinsics(cv::FileStorage& file) {
  file << "R" << cv::Mat(rotation()) << "T" << cv::Mat(kT) << "Q" << cv::Mat::eye(4, 4, CV_64F);
}
template <class Write>
std::string opencv_text(const Write& write) {
  cv::FileStorage file(".yml",
                       cv::FileStorage::WRITE | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  write(file);
  return file.releaseAndGetString();
}

std::vector<std::string> problems_of(const std::string& text) {
  try {
    parse_stereo_calibration(text, "stereo.yml");
  } catch (const InputError& error) {
    std::vector<std::string> lines;
    for (const Problem& problem : error.problems()) lines.push_back(problem.text());
    return lines;
  }
  return {};
}

void expect_calibration(const StereoCalibration& read) {
  EXPECT_EQ(read.M1, kM1);
  EXPECT_EQ(read.M2, kM2);
  EXPECT_THAT(read.D1, ElementsAre(-0.2, 0.1, 1e-3, -2e-3, 0.01));
  EXPECT_THAT(read.D2, ElementsAre(-0.21, 0.11, 0, 0));
  EXPECT_EQ(read.R, rotation());
  EXPECT_EQ(read.T, kT);
  EXPECT_FALSE(read.chosen);
}

TEST(StereoCalibration, ReadsWhatOpenCvWrites) {
  const StereoCalibration read = parse_stereo_calibration(opencv_text([](cv::FileStorage& file) {
                                                            file << "image_width" << 640 << "image_height"
                                                                 << 480;
                                                            write_intrinsics(file);
                                                            write_extrinsics(file);
                                                          }),
                                                          "stereo.yml");
  expect_calibration(read);
  EXPECT_EQ(read.size.value(), cv::Size(640, 480));
}

TEST(StereoCalibration, ReadsTheTwoFilesOfOpenCvsSample) {
  const auto folder = std::filesystem::temp_directory_path() / "groundloop_stereo_calibration";
  std::filesystem::create_directories(folder);
  const std::string intrinsics = (folder / "intrinsics.yml").string();
  const std::string extrinsics = (folder / "extrinsics.yml").string();
  std::ofstream(intrinsics) << opencv_text(write_intrinsics);
  std::ofstream(extrinsics) << opencv_text(write_extrinsics);
  const StereoCalibration read = read_stereo_calibration({intrinsics, extrinsics});
  expect_calibration(read);
  EXPECT_FALSE(read.size);
  EXPECT_THROW(read_stereo_calibration({intrinsics}), InputError);
  std::filesystem::remove_all(folder);
}

TEST(StereoCalibration, TakesTheRectificationOfTheFile) {
  const cv::Matx34d P1(450, 0, 300, 0, 0, 450, 240, 0, 0, 0, 1, 0);
  cv::Matx34d P2 = P1;
  P2(0, 3) = -450 * 0.09;
  const StereoCalibration read = parse_stereo_calibration(opencv_text([&](cv::FileStorage& file) {
                                                            write_intrinsics(file);
                                                            file << "R1" << cv::Mat(rotation()) << "R2"
                                                                 << cv::Mat(rotation()) << "P1" << cv::Mat(P1)
                                                                 << "P2" << cv::Mat(P2);
                                                          }),
                                                          "stereo.yml");
  ASSERT_TRUE(read.chosen);
  EXPECT_EQ(read.chosen->R1, rotation());
  EXPECT_EQ(read.chosen->P2, P2);
}

TEST(StereoCalibration, NamesEveryProblemWithItsLine) {
  const std::string text =
      "%YAML:1.0\n---\n"
      "M1: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 1., 0., 2. ]\n"
      "image_width: many\n";
  const std::vector<std::string> lines = problems_of(text);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], "stereo.yml:8: image_width: many: wanted a whole number from 1 to 65536");
  EXPECT_EQ(lines[1], "stereo.yml:7: M1.data: 3 numbers: wanted 9, in 3 rows of 3");
}

TEST(StereoCalibration, SaysWhatIsMissingOrMeansNothing) {
  EXPECT_THAT(problems_of(opencv_text(write_intrinsics)),
              ElementsAre(HasSubstr("stereo.yml: R: missing"), HasSubstr("stereo.yml: T: missing")));
  const std::string mirrored = opencv_text([](cv::FileStorage& file) {
    write_intrinsics(file);
    file << "R" << cv::Mat(-cv::Mat::eye(3, 3, CV_64F)) << "T" << cv::Mat::zeros(1, 4, CV_64F);
  });
  EXPECT_THAT(problems_of(mirrored),
              ElementsAre(HasSubstr("wanted a rotation"), HasSubstr("T: 1 x 4: wanted a 3 x 1 matrix")));
  EXPECT_THAT(problems_of("%YAML:1.0\n---\nM1: [1, 2"), ElementsAre(HasSubstr("stereo.yml:")));
}

}  // namespace
}  // namespace groundloop::slam
