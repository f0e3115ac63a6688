#include "slam/source/kitti_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "slam/types/config.h"
#include "tests/slam/source/temporary_folder.h"

namespace groundloop::slam {
namespace {

constexpr const char* kCalib =
    "P0: 500 0 31.5 0 0 510 23.5 0 0 0 1 0\n"
    "P1: 500 0 29.5 -60 0 510 23.5 0 0 0 1 0\n";

cv::Mat image_of(int pair, int camera) {
  cv::Mat image(48, 64, CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u)
      image.at<uint8_t>(v, u) = static_cast<uint8_t>(3 * u + v + 50 * pair + camera);
  }
  return image;
}

/// Three pairs at 0, 0.1 and 0.25 s.
void write_sequence(const TemporaryFolder& folder) {
  folder.write("calib.txt", kCalib);
  folder.write("times.txt", "0.000000e+00\n1.000000e-01\n2.500000e-01\n");
  for (const int camera : {0, 1}) {
    std::filesystem::create_directories(folder.path("image_" + std::to_string(camera)));
    for (int i = 0; i < 3; ++i) {
      cv::imwrite(folder.path("image_" + std::to_string(camera) + "/00000" + std::to_string(i) + ".png"),
                  image_of(i, camera));
    }
  }
}

/// Messages of an InputError without the folder's name.
std::vector<std::string> messages(const TemporaryFolder& folder, const std::function<void()>& run) {
  std::vector<std::string> lines;
  try {
    run();
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      EXPECT_EQ(problem.file.find(folder.path()), 0U) << problem.file;
      lines.push_back(problem.text().substr(folder.path().size() + 1));
    }
  }
  return lines;
}
std::vector<std::string> messages_of_opening(const TemporaryFolder& folder) {
  return messages(folder, [&] { KittiSource source(folder.path()); });
}
using Lines = std::vector<std::string>;

TEST(KittiSource, ReadsTheCalibration) {
  const TemporaryFolder folder;
  write_sequence(folder);
  const KittiSource source(folder.path(), {.camera_height_m = 0.8});
  const StereoRig& rig = source.rig();
  EXPECT_EQ(rig.width_px, 64);
  EXPECT_EQ(rig.height_px, 48);
  EXPECT_EQ(rig.fx_px, 500);
  EXPECT_EQ(rig.fy_px, 510);
  EXPECT_EQ(rig.cx_px, 31.5);
  EXPECT_EQ(rig.cy_px, 23.5);
  EXPECT_EQ(rig.cx_right_px, 29.5);
  EXPECT_DOUBLE_EQ(rig.baseline_m, 0.12);
  EXPECT_TRUE(rig.T_body_left.isApprox(StereoRig::level_camera({0, 0, 0.8})));
}

TEST(KittiSource, ReadsColonlessAndForeignLinesOfACalibration) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("calib.txt",
               "# made by hand\n\nP1 500 0 31.5 -60 0 500 23.5 0 0 0 1 0\r\nP2: 1 2 3\nTr: 1 0 0\n"
               "P0 500 0 31.5 0 0 500 23.5 0 0 0 1 0\n");
  EXPECT_DOUBLE_EQ(KittiSource(folder.path()).rig().baseline_m, 0.12);
}

TEST(KittiSource, DeliversEveryPairInOrder) {
  const TemporaryFolder folder;
  write_sequence(folder);
  KittiSource source(folder.path());
  EXPECT_EQ(source.size(), 3);
  EXPECT_FALSE(source.out_of_order());
  const std::vector<int64_t> stamps_ns = {0, 100000000, 250000000};
  for (int i = 0; i < 3; ++i) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_EQ(frame->stamp_ns, stamps_ns[i]);
    EXPECT_EQ(frame->left.type(), CV_8UC1);
    EXPECT_EQ(cv::norm(frame->left, image_of(i, 0), cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(frame->right, image_of(i, 1), cv::NORM_INF), 0);
    EXPECT_FALSE(frame->T_previous_left);
  }
  EXPECT_FALSE(source.next());
  EXPECT_FALSE(source.next());
}

TEST(KittiSource, DeliversPairsListedInAnyOrderInOrderOfTime) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("times.txt", "0.5\n-98.449999872\n14\n");
  KittiSource source(folder.path());
  EXPECT_TRUE(source.out_of_order());
  EXPECT_EQ(source.stamps_ns(), (std::vector<int64_t>{-98449999872, 500000000, 14000000000}));
  for (const int pair : {1, 0, 2}) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(cv::norm(frame->left, image_of(pair, 0), cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(frame->right, image_of(pair, 1), cv::NORM_INF), 0);
  }
}

TEST(KittiSource, RefusesTwoPairsOfOneTime) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("times.txt", "0.5\n0.1\n0.5\n");
  EXPECT_EQ(messages(folder, [&] { KittiSource(folder.path()); }),
            (Lines{"times.txt:3: 0.5: wanted a time that no other pair has"}));
}

TEST(KittiSource, ConvertsColourToGrey) {
  const TemporaryFolder folder;
  write_sequence(folder);
  cv::imwrite(folder.path("image_0/000000.png"), cv::Mat(48, 64, CV_8UC3, cv::Scalar(0, 255, 0)));
  const auto frame = KittiSource(folder.path()).next();
  EXPECT_EQ(frame->left.type(), CV_8UC1);
  EXPECT_NEAR(frame->left.at<uint8_t>(5, 5), 0.587 * 255, 1);
}

TEST(KittiSource, NamesEverythingThatIsMissingAtOnce) {
  const TemporaryFolder folder;
  EXPECT_EQ(messages_of_opening(folder),
            (Lines{"calib.txt: no such file: wanted KITTI calibration: lines \"P0: ...\" and \"P1: ...\" of "
                   "12 numbers each",
                   "times.txt: no such file: wanted a text file, one time in seconds a line",
                   "image_0: no such folder: wanted a folder of PNG images",
                   "image_1: no such folder: wanted a folder of PNG images"}));
}

TEST(KittiSource, NamesTheWrongLineOfTheCalibration) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("calib.txt", "P0: 500 0 31.5 0 0 500 23.5 0 0 0 1\nP1: 500 0 many -60 0 500 23.5 0 0 0 1 0\n");
  EXPECT_EQ(
      messages_of_opening(folder),
      (Lines{
          "calib.txt:1: P0: 11 numbers: wanted 12 numbers", "calib.txt:2: P1: many: wanted a number",
          "calib.txt: P0: missing: wanted KITTI calibration: lines \"P0: ...\" and \"P1: ...\" of 12 numbers "
          "each"}));
}

TEST(KittiSource, RefusesAPairThatIsNotRectified) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("calib.txt", "P0: 500 0 31.5 0 0 500 23.5 0 0 0 1 0\nP1: 499 0 31.5 60 0 500 24 0 0 0 1 0\n");
  EXPECT_EQ(messages_of_opening(folder),
            (Lines{"calib.txt: P1[0]: 499: wanted fx as in P0, 500: a rectified pair",
                   "calib.txt: P1[6]: 24: wanted cy as in P0, 23.5: a rectified pair",
                   "calib.txt: P1[3]: 60: wanted -fx * baseline, less than P0[3]"}));
}

TEST(KittiSource, NamesTheWrongTimes) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("times.txt", "0\nnoon\n0.2 0.3\n0.0\n");
  EXPECT_EQ(messages_of_opening(folder), (Lines{"times.txt:2: noon: wanted a time in seconds",
                                                "times.txt:3: 0.2 0.3: wanted a time in seconds",
                                                "times.txt:4: 0.0: wanted a time that no other pair has"}));
  folder.write("times.txt", "\n");
  EXPECT_EQ(messages_of_opening(folder),
            Lines{"times.txt: no times: wanted a text file, one time in seconds a line"});
}

TEST(KittiSource, CountsImagesAgainstTimes) {
  const TemporaryFolder folder;
  write_sequence(folder);
  std::filesystem::remove(folder.path("image_1/000001.png"));
  EXPECT_EQ(messages_of_opening(folder),
            Lines{"image_1: 2 PNG images: wanted 3, one for every line of times.txt"});
}

TEST(KittiSource, NamesTheImageThatIsBroken) {
  const TemporaryFolder folder;
  write_sequence(folder);
  folder.write("image_1/000001.png", "not an image");
  cv::imwrite(folder.path("image_0/000002.png"), cv::Mat(40, 64, CV_8UC1, cv::Scalar(9)));
  KittiSource source(folder.path());
  EXPECT_TRUE(source.next());
  EXPECT_EQ(messages(folder, [&] { source.next(); }),
            Lines{"image_1/000001.png: cannot be decoded: wanted an image that can be read"});
  folder.write("image_1/000001.png", "");
  std::filesystem::copy_file(folder.path("image_1/000000.png"), folder.path("image_1/000001.png"),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_TRUE(source.next());
  EXPECT_EQ(messages(folder, [&] { source.next(); }),
            Lines{"image_0/000002.png: 64x40 pixels: wanted 64x48 pixels"});
}

TEST(KittiSource, OpensTheRecordedSequences) {
  const char* named = std::getenv("GROUNDLOOP_DATA");
  const std::string data = named != nullptr ? named : "../shared/data";
  if (!std::filesystem::is_directory(data)) GTEST_SKIP() << "no recorded data at " << data;
  KittiSource source(data + "/kitti06_0-50");
  EXPECT_EQ(source.size(), 51);
  EXPECT_EQ(source.rig().width_px, 1226);
  EXPECT_EQ(source.rig().height_px, 370);
  EXPECT_NEAR(source.rig().baseline_m, 0.53715, 1e-5);
  int frames = 0;
  for (int64_t last_ns = -1; const auto frame = source.next(); ++frames) {
    EXPECT_GT(frame->stamp_ns, last_ns);
    last_ns = frame->stamp_ns;
  }
  EXPECT_EQ(frames, 51);
}

}  // namespace
}  // namespace groundloop::slam
