// One pair made again, alone, by either backend.
#include <gmock/gmock.h>

#include "tests/runs/program.h"

namespace groundloop::bench {
namespace {

TEST(Frame, BothBackendsGiveTheSameBytes) {
  const Workspace workspace;
  for (const std::string backend : {"osmesa", "egl"}) {
    const Answer answer = groundloop(
        {"frame", "scenarios/smoke.yaml", "12", "--renderer", backend, "--out", workspace.path(backend)});
    ASSERT_EQ(answer.exit_code, 0) << answer.err;
  }
  const std::vector<std::string> files = workspace.entries("osmesa");
  EXPECT_THAT(files, testing::ElementsAre("depth.pfm", "disparity.png", "flow.flo", "geoms.png",
                                          "instances.png", "labels.csv", "left.png", "moving.png",
                                          "right.png", "visible_next.png", "visible_right.png"));
  for (const std::string& file : files) {
    EXPECT_TRUE(text_of(workspace.path("osmesa/" + file)) == text_of(workspace.path("egl/" + file))) << file;
  }
}

TEST(Frame, SaysWhatItCannotMake) {
  const Workspace workspace;
  const Answer beyond = groundloop({"frame", "scenarios/smoke.yaml", "99", "--out", workspace.path("out")});
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_THAT(beyond.err, testing::HasSubstr("frame: 99: wanted a pair of the run, 0 to "));
  const Answer steered = groundloop(
      {"frame", "scenarios/smoke.yaml", "1", "--set", "plan.feedback=slam", "--out", workspace.path("out")});
  EXPECT_EQ(steered.exit_code, 2);
  EXPECT_THAT(steered.err, testing::HasSubstr("plan.feedback: slam: wanted"));
}

}  // namespace
}  // namespace groundloop::bench
