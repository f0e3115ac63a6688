// A run that does not come to its end leaves nothing that looks finished.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/runs/program.h"

namespace groundloop::bench {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kLong = "scenarios/lab_p3dx.yaml";

TEST(StoppedRun, CtrlCEndsItCleanlyAndLeavesNothing) {
  const Workspace workspace;
  const Answer answer =
      groundloop_with_signal({"run", kLong, "--frames", "60", "--out", workspace.path("run")}, SIGINT);
  EXPECT_EQ(answer.exit_code, 130);
  EXPECT_EQ(answer.complaint(), "groundloop: stopped before the end; nothing was written");
  EXPECT_EQ(answer.out, "");
  EXPECT_THAT(workspace.entries(), IsEmpty());
}

TEST(StoppedRun, CtrlCEndsAllOfSeveralRuns) {
  const Workspace workspace;
  const Answer answer = groundloop_with_signal(
      {"run", "scenarios/smoke.yaml", "--seed", "1..3", "--jobs", "2", "--out", workspace.path("runs")},
      SIGTERM);
  EXPECT_EQ(answer.exit_code, 130);
  for (const std::string& name : workspace.entries()) EXPECT_EQ(name, "runs");  // the empty parent at most
}

TEST(StoppedRun, KilledItHasNoFolderThatLooksFinished) {
  const Workspace workspace;
  const std::vector<std::string> arguments = {"run", kLong, "--frames", "60", "--out", workspace.path("run")};
  const Answer answer = groundloop_with_signal(arguments, SIGKILL);
  EXPECT_EQ(answer.signal, SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(workspace.path("run")));
  for (const std::string& name : workspace.entries()) {
    EXPECT_THAT(name, HasSubstr("run.unfinished-"));
    EXPECT_THAT(name, testing::Not(EndsWith("/run.json")));
  }
}

}  // namespace
}  // namespace groundloop::bench
