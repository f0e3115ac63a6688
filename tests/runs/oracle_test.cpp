// A run with exact answers in the place of a stage, by the program itself.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/runs/program.h"

namespace groundloop::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

json metrics_of(const std::string& folder) { return json::parse(text_of(folder + "/metrics.json")); }

TEST(OracleRun, ExactMotionGivesTheTruePathAndSaysSoEverywhere) {
  const Workspace workspace;
  const std::string folder = workspace.path("run"), junit = workspace.path("run.xml");
  const Answer answer = groundloop({"run", "scenarios/smoke.yaml", "--frames", "8", "--oracle", "motion",
                                    "--out", folder, "--junit", junit});
  ASSERT_EQ(answer.exit_code, 0) << answer.out << answer.err;
  EXPECT_LT(metrics_of(folder)["trajectory.ate_rmse_m"], 1e-6);
  EXPECT_LT(metrics_of(folder)["trajectory.end_yaw_deg"], 1e-6);

  EXPECT_THAT(answer.out, StartsWith("smoke (exact motion) seed 1: pass"));
  EXPECT_THAT(text_of(junit), HasSubstr("smoke (exact motion) seed 1"));
  EXPECT_EQ(json::parse(text_of(folder + "/run.json"))["oracles"], "motion");
  EXPECT_THAT(text_of(folder + "/report.html"), HasSubstr("exact answers in the place of motion"));
}

}  // namespace
}  // namespace groundloop::bench
