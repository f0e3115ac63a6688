#include "slam/loop/loop_detector.h"

#include <gtest/gtest.h>

#include <map>
#include <opencv2/core/utility.hpp>

#include "tests/slam/loop/painted_room.h"

namespace groundloop::slam {
namespace {

/// What a trajectory would say: the true poses, with an uncertainty that grows with the frames between.
class Odometry {
 public:
  void add(int64_t index, const Pose& T_room_left) { poses_[index] = T_room_left; }

  RelativePose everything() const {
    return [this](int64_t from, int64_t to) { return between(from, to); };
  }
  double error_m(const LoopLink& link) const {
    const Pose T_from_to = between(link.from_index, link.to_index).T_from_to;
    return (link.T_from_to.translation() - T_from_to.translation()).norm();
  }
  /// As after a kidnapping at frame `at`: nothing connects what was before with what came after.
  RelativePose broken_at(int64_t at) const {
    return [this, at](int64_t from, int64_t to) -> std::optional<PosePrediction> {
      if ((from < at) != (to < at)) return std::nullopt;
      return between(from, to);
    };
  }

 private:
  PosePrediction between(int64_t from, int64_t to) const {
    PosePrediction prediction{poses_.at(from).inverse() * poses_.at(to), Matrix6d::Zero()};
    const double sigma = 1e-3 + 1e-4 * static_cast<double>(std::abs(to - from));
    prediction.covariance.diagonal().setConstant(sigma * sigma);
    return prediction;
  }
  std::map<int64_t, Pose> poses_;
};

/// Along the far wall, 0.6 m a key frame, ten frames each.
Pose along_the_wall(double x_m) { return PaintedRoom::T_room_left(x_m, 0.8, 90); }
constexpr int64_t kFrames = 10;

/// Drives along the wall from x = first to last and returns the answers.
std::vector<LoopAnswer> drive(const PaintedRoom& room, const std::vector<double>& path_m, int64_t first_index,
                              Odometry& odometry, const RelativePose& relative_pose, LoopDetector& detector) {
  std::vector<LoopAnswer> answers;
  int64_t index = first_index;
  for (const double x_m : path_m) {
    odometry.add(index, along_the_wall(x_m));
    answers.push_back(detector.process(room.key_frame(index, along_the_wall(x_m)), relative_pose));
    index += kFrames;
  }
  return answers;
}

const std::vector<double> kThere = {-4, -3.4, -2.8, -2.2, -1.6, -1};

TEST(LoopDetector, KnowsThePlacesOfASecondVisitAndStoresThemOnce) {
  const PaintedRoom room(1);
  LoopDetector detector = make_detector();
  Odometry odometry;
  for (const LoopAnswer& answer : drive(room, kThere, 0, odometry, odometry.everything(), detector)) {
    EXPECT_FALSE(answer.link) << "nobody came back yet";
    EXPECT_TRUE(answer.stored);
  }
  EXPECT_EQ(detector.views().size(), kThere.size());
  const size_t bytes = detector.bytes();

  const std::vector<double> back = {-1.5, -2.1, -3.3};
  const auto answers = drive(room, back, 200, odometry, odometry.everything(), detector);
  for (size_t i = 0; i < answers.size(); ++i) {
    ASSERT_TRUE(answers[i].link) << answers[i].message;
    const LoopLink& link = *answers[i].link;
    EXPECT_EQ(link.to_index, 200 + static_cast<int64_t>(i) * kFrames);
    EXPECT_LT(odometry.error_m(link), 0.01);
    EXPECT_LT(link.T_from_to.translation().norm(), 0.7) << "a nearer view was stored";
    EXPECT_FALSE(answers[i].stored);
  }
  EXPECT_EQ(detector.bytes(), bytes);
}

TEST(LoopDetector, YoungViewsAreNoLoops) {
  const PaintedRoom room(1);
  LoopOptions options;
  options.min_age_frames = 100;
  LoopDetector detector = make_detector(options);
  Odometry odometry;
  const auto answers = drive(room, {-4, -3.9, -3.8}, 0, odometry, odometry.everything(), detector);
  for (const LoopAnswer& answer : answers) {
    EXPECT_FALSE(answer.link);
    EXPECT_EQ(answer.message, "no stored view looks alike");
  }
}

TEST(LoopDetector, AfterAKidnappingTwoKeyFramesMustAgree) {
  const PaintedRoom room(1);
  LoopDetector detector = make_detector();
  Odometry odometry;
  drive(room, kThere, 0, odometry, odometry.everything(), detector);
  const auto answers = drive(room, {-2.5, -2.0, -1.5}, 200, odometry, odometry.broken_at(200), detector);
  EXPECT_FALSE(answers[0].link);
  EXPECT_EQ(answers[0].message, "waits for the next key frame to agree");
  ASSERT_TRUE(answers[1].link) << answers[1].message;
  ASSERT_TRUE(answers[2].link) << answers[2].message;
  EXPECT_LT(odometry.error_m(*answers[1].link), 0.01);
}

TEST(LoopDetector, DoesNotChooseBetweenTwoPlacesThatLookTheSame) {
  // Both copies of the corridor's period were seen before.
  const PaintedRoom corridor(4, {.period_m = 4, .posters = {}});
  LoopDetector detector = make_detector();
  Odometry odometry;
  drive(corridor, {-3, -2.4, 1, 1.6}, 0, odometry, odometry.everything(), detector);
  const auto answers = drive(corridor, {-2.9, -2.5}, 200, odometry, odometry.broken_at(200), detector);
  for (const LoopAnswer& answer : answers) {
    EXPECT_FALSE(answer.link);
    EXPECT_EQ(answer.message, "two places look the same");
  }
  // With odometry there is no doubt.
  const auto known = drive(corridor, {-2.9}, 300, odometry, odometry.everything(), detector);
  ASSERT_TRUE(known[0].link) << known[0].message;
  EXPECT_LT(odometry.error_m(*known[0].link), 0.01);
}

TEST(LoopDetector, StopsStoringWhenItIsFull) {
  const PaintedRoom room(1);
  LoopOptions options;
  options.max_views = 2;
  LoopDetector detector = make_detector(options);
  Odometry odometry;
  const auto answers = drive(room, {-4, -3, -2}, 0, odometry, odometry.everything(), detector);
  EXPECT_TRUE(answers[1].stored);
  EXPECT_FALSE(answers[2].stored);
  EXPECT_EQ(detector.views().size(), 2U);
}

TEST(LoopDetector, AnswersTheSameWithAnyNumberOfThreads) {
  const PaintedRoom room(6);
  const int threads = cv::getNumThreads();
  std::vector<LoopLink> links;
  for (const int count : {1, 3}) {
    cv::setNumThreads(count);
    LoopDetector detector = make_detector();
    Odometry odometry;
    drive(room, {-4, -3.4}, 0, odometry, odometry.everything(), detector);
    const auto answers = drive(room, {-3.6}, 200, odometry, odometry.everything(), detector);
    ASSERT_TRUE(answers[0].link) << answers[0].message;
    links.push_back(*answers[0].link);
  }
  cv::setNumThreads(threads);
  EXPECT_EQ(links[0].from_index, links[1].from_index);
  EXPECT_EQ(links[0].T_from_to.matrix(), links[1].T_from_to.matrix());
  EXPECT_EQ(links[0].covariance, links[1].covariance);
  EXPECT_EQ(links[0].residual_px, links[1].residual_px);
}

}  // namespace
}  // namespace groundloop::slam
