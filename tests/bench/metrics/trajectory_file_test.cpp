#include "bench/metrics/trajectory_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/metrics/poses.h"
#include "tests/bench/metrics/test_folder.h"

namespace groundloop::bench {
namespace {

using testing::HasSubstr;

template <class Read>
std::string message_of(Read read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(TrajectoryFile, ReadsTumWithCommentsAndBlankLines) {
  const TestFolder folder;
  const std::string file =
      folder.write("a.tum",
                   "# timestamp tx ty tz qx qy qz qw\n\n"
                   "1311868164.363181234 1 2 3 0 0 0.70710678118654757 0.70710678118654757\n"
                   "  \t\n"
                   "1311868165.5\t4  5 6 0 0 0 1\r\n");
  const TrajectoryFile read = read_trajectory(file);
  EXPECT_EQ(read.format, TrajectoryFormat::kTum);
  ASSERT_EQ(read.poses.size(), 2u);
  EXPECT_EQ(read.poses[0].stamp_ns, 1311868164363181234);
  EXPECT_EQ(read.poses[1].stamp_ns, 1311868165500000000);
  EXPECT_TRUE(read.poses[0].T.isApprox(moved(1, 2, 3) * turned(90, Eigen::Vector3d::UnitZ()), 1e-14));
  EXPECT_TRUE(read.poses[1].T.isApprox(moved(4, 5, 6), 1e-14));
}

TEST(TrajectoryFile, ReadsStampsInScientificNotation) {
  const TestFolder folder;
  const auto read = read_trajectory(folder.write("a.tum", "1.403715529112143517e+09 0 0 0 0 0 0 1\n"));
  EXPECT_EQ(read.poses[0].stamp_ns, 1403715529112143517);
}

TEST(TrajectoryFile, NormalisesQuaternions) {
  const TestFolder folder;
  const auto read = read_trajectory(folder.write("a.tum", "0 0 0 0 0 0 0.707 0.707\n"));
  EXPECT_TRUE(read.poses[0].T.isApprox(turned(90, Eigen::Vector3d::UnitZ()), 1e-14));
}

TEST(TrajectoryFile, ReadsKittiAndStampsByLine) {
  const TestFolder folder;
  const auto read =
      read_trajectory(folder.write("a.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 7 1 0 0 8 0 0 1 9\n"));
  EXPECT_EQ(read.format, TrajectoryFormat::kKitti);
  EXPECT_FALSE(read.has_stamps());
  ASSERT_EQ(read.poses.size(), 2u);
  EXPECT_EQ(read.poses[1].stamp_ns, 1'000'000'000);
  EXPECT_TRUE(read.poses[1].T.isApprox(moved(7, 8, 9) * turned(90, Eigen::Vector3d::UnitZ()), 1e-14));
}

TEST(TrajectoryFile, ReadsEurocWithFurtherColumnsAndScalarFirst) {
  const TestFolder folder;
  const auto read = read_trajectory(
      folder.write("a.csv", "#timestamp, p_x, ...\n1403715524907143168,1,2,3, 0.5,0.5,0.5,0.5, 9,9,9\n"));
  EXPECT_EQ(read.format, TrajectoryFormat::kEuroc);
  ASSERT_EQ(read.poses.size(), 1u);
  EXPECT_EQ(read.poses[0].stamp_ns, 1403715524907143168);
  EXPECT_TRUE(read.poses[0].T.isApprox(moved(1, 2, 3) * turned(120, {1, 1, 1}), 1e-14));
}

TEST(TrajectoryFile, WhatIsWrittenReadsBack) {
  const TestFolder folder;
  slam::Trajectory poses;
  for (int i = 0; i < 20; ++i) {
    poses.push_back({1403715524907143168 + i * 133333333LL,
                     moved(0.1 * i, -1.0 / (i + 1), 3) * turned(17.0 * i, {1.0, 0.3 * i, -0.2})});
  }
  write_tum(folder.path("a.tum"), poses);
  write_kitti(folder.path("a.txt"), poses);
  const auto tum = read_trajectory(folder.path("a.tum")).poses;
  const auto kitti = read_trajectory(folder.path("a.txt")).poses;
  ASSERT_EQ(tum.size(), poses.size());
  ASSERT_EQ(kitti.size(), poses.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(tum[i].stamp_ns, poses[i].stamp_ns);
    EXPECT_LT((tum[i].T.matrix() - poses[i].T.matrix()).norm(), 1e-11);
    EXPECT_LT((kitti[i].T.matrix() - poses[i].T.matrix()).norm(), 1e-11);
  }
}

TEST(TrajectoryFile, TumLineHasTheNanosecondAlsoBeforeZero) {
  EXPECT_EQ(tum_line({1, moved(1, -2, 0.5)}),
            "0.000000001 1.000000000000 -2.000000000000 0.500000000000 "
            "0.000000000000 0.000000000000 0.000000000000 1.000000000000");
  EXPECT_THAT(tum_line({-1'500'000'000, moved(0, 0, 0)}), testing::StartsWith("-1.500000000 "));
}

TEST(TrajectoryFile, NamesFileLineValueAndWhatWasWanted) {
  const TestFolder folder;
  const std::string file = folder.write("a.tum",
                                        "0 0 0 0 0 0 0 1\n"
                                        "# fine\n"
                                        "1 0 zero 0 0 0 0 1\n"
                                        "2 0 nan 0 0 0 0 1\n"
                                        "3 0 0 0 0 0 0\n"
                                        "4 0 0 0 0 0 0 2\n"
                                        "x 0 0 0 0 0 0 1\n"
                                        "5 0 0 0 0 0 0 1\n"
                                        "4.5 0 0 0 0 0 0 1\n");
  EXPECT_EQ(message_of([&] { read_trajectory(file); }),
            file + ":3: zero: wanted a finite number\n" +  //
                file + ":4: nan: wanted a finite number\n" + file +
                ":5: 7 columns: wanted 8 columns: seconds x y z qx qy qz qw\n" + file +
                ":6: quaternion of norm 2: wanted a unit quaternion\n" + file +
                ":7: x: wanted a time in seconds\n" + file +
                ":9: 4.5 0 0 0 0 0 0 1: wanted a time not before that of the line above");
}

TEST(TrajectoryFile, RefusesAMatrixThatIsNoRotation) {
  const TestFolder folder;
  const std::string file = folder.write("a.txt", "1 0 0 0 0 1 0 0 0 0 -1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(message_of([&] { read_trajectory(file); }),
            file + ":1: |R'R - I| = 0, det R = -1: wanted a rotation matrix\n" +  //
                file + ":2: |R'R - I| = 3, det R = 2: wanted a rotation matrix");
}

TEST(TrajectoryFile, RefusesEurocWithFloatingNonsense) {
  const TestFolder folder;
  const std::string file = folder.write("a.csv", "soon,0,0,0,1,0,0,0\n1,0,,0,1,0,0,0\n");
  EXPECT_EQ(message_of([&] { read_trajectory(file); }), file +
                                                            ":1: soon: wanted a time in nanoseconds\n" +  //
                                                            file + ":2: wanted a finite number");
}

TEST(TrajectoryFile, ListsAtMostTwentyProblems) {
  const TestFolder folder;
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "bad 0 0 0 0 0 0 1\n";
  const std::string file = folder.write("a.tum", text);
  try {
    read_trajectory(file);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 20u);
  }
}

TEST(TrajectoryFile, SaysWhatAFileWithoutPosesLacks) {
  const TestFolder folder;
  const std::string empty = folder.write("empty.tum", "# nothing\n");
  EXPECT_EQ(message_of([&] { read_trajectory(empty); }),
            empty + ": no pose: wanted at least one line with a pose");
  EXPECT_EQ(message_of([&] { read_trajectory("absent.tum"); }),
            "absent.tum: no such file: wanted a trajectory file");
  EXPECT_THAT(message_of([&] { read_trajectory(folder.path("")); }), HasSubstr("no such file"));
  const std::string odd = folder.write("odd.txt", "1 2 3\n");
  EXPECT_EQ(message_of([&] { read_trajectory(odd); }),
            odd + ":1: 1 2 3: wanted 8 columns (TUM), 12 columns (KITTI) or columns with commas (EuRoC)");
}

TEST(TrajectoryFile, SaysWhereItCannotWrite) {
  EXPECT_EQ(message_of([] { write_tum("no/such/folder/a.tum", straight(2, 1)); }),
            "no/such/folder/a.tum: cannot be written: wanted a file in a writable folder");
}

TEST(TrajectoryFile, PosesOfAnyOrderArePutInOrderOfTime) {
  const TestFolder folder;
  const std::string file =
      folder.write("any.tum", "0.5 1 0 0 0 0 0 1\n-98.25 2 0 0 0 0 0 1\n14 3 0 0 0 0 0 1\n");
  const slam::Trajectory poses = read_trajectory(file, StampOrder::kAny).poses;
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[0].stamp_ns, -98250000000);
  EXPECT_EQ(poses[0].T.translation().x(), 2);
  EXPECT_EQ(poses[2].T.translation().x(), 3);
}

}  // namespace
}  // namespace groundloop::bench
