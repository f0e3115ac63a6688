#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "slam/loop/loop_verifier.h"
#include "slam/source/kitti_source.h"
#include "tests/slam/loop/painted_room.h"

namespace groundloop::slam {
namespace {

struct RecordedView {
  CurrentView view;
  Pose T_world_left;
};

/// Lines of poses.txt: 3 x 4 matrices, one a pair in the order of the files.
std::vector<Pose> read_poses(const std::string& file) {
  std::ifstream text(file);
  std::vector<Pose> poses;
  for (Pose T = Pose::Identity(); text;) {
    for (int i = 0; i < 12; ++i) text >> T.matrix()(i / 4, i % 4);
    if (text) poses.push_back(T);
  }
  return poses;
}

/// Two places of EuRoC V1_01, each seen twice from far apart: pairs 0 and 1 (0.447 m, 37.5 degrees), 2 and 3
/// (0.315 m, 15.6 degrees). Same place or not is known for all twelve ordered pairs.
TEST(RecordedPairs, AreLinkedWithinTheirPlaceAndNotAcross) {
  const char* named = std::getenv("GROUNDLOOP_DATA");
  const std::string data = named != nullptr ? named : "../shared/data";
  const std::string directory = data + "/euroc_v101_lc_pairs";
  if (!std::filesystem::is_directory(directory)) GTEST_SKIP() << "no recorded data at " << directory;

  KittiSource source(directory);
  const std::vector<Pose> poses = read_poses(directory + "/poses.txt");
  ASSERT_EQ(poses.size(), 4U);
  const int pair_of[4] = {1, 0, 3, 2};  // the order of their times
  std::vector<RecordedView> views(4);
  for (const int pair : pair_of) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    views[static_cast<size_t>(pair)] = {
        current_view(make_key_frame(source.rig(), pair, frame->left, frame->right, DetectionOptions{})),
        poses[static_cast<size_t>(pair)]};
  }

  LoopVerifier verifier(source.rig(), LoopOptions{}, KltOptions{}, StereoOptions{}, RegistrationOptions{});
  for (size_t from = 0; from < 4; ++from) {
    for (size_t to = 0; to < 4; ++to) {
      if (from == to) continue;
      SCOPED_TRACE(std::to_string(from) + " to " + std::to_string(to));
      const Verification found = verifier.verify(views[from].view.view, views[to].view, std::nullopt, 1);
      const bool same_place = from / 2 == to / 2;
      EXPECT_EQ(found.accepted, same_place) << found.message;
      if (!found.accepted || !same_place) continue;
      const Pose T_from_to = views[from].T_world_left.inverse() * views[to].T_world_left;
      const Vector6d error = se3_log(T_from_to.inverse() * found.link.T_from_to);
      EXPECT_LT(error.head<3>().norm(), 0.03);
      EXPECT_LT(error.tail<3>().norm(), 0.3 * std::numbers::pi / 180);
    }
  }
}

}  // namespace
}  // namespace groundloop::slam
