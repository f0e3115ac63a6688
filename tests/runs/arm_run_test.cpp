// A short run of the arm, by the program itself.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/runs/program.h"

namespace groundloop::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::SizeIs;

std::vector<double> numbers_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<double> numbers;
  for (double number = 0; in >> number;) numbers.push_back(number);
  return numbers;
}

/// A run of the tabletop's first pairs at a scale; its folder.
std::string run_at(const Workspace& workspace, const std::string& scale) {
  const std::string folder = workspace.path("run-" + scale);
  const Answer answer = groundloop(
      {"run", "scenarios/arm_tabletop.yaml", "--frames", "10", "--set", "scale=" + scale, "--out", folder});
  EXPECT_EQ(answer.exit_code, 0) << answer.out << answer.err;
  return folder;
}

/// Where the plan says, with the paper's figures; and, the scale study in small, with everything 4.4 times as
/// large the same in another unit: cells and layers are those of a room, and the error is so many times as
/// large, but for what rounding made different.
TEST(ArmRun, IsTheSameExperimentOneToFourAndOneToOne) {
  const Workspace workspace;
  const std::string small = run_at(workspace, "1"), large = run_at(workspace, "4.4");
  const auto truth = lines_of(small + "/truth.tum"), estimate = lines_of(small + "/estimate.tum");
  ASSERT_THAT(truth, SizeIs(10));
  const auto first = numbers_of(truth[0]), second = numbers_of(truth[1]);
  EXPECT_NEAR(first[1], -0.2, 1e-5);
  EXPECT_NEAR(first[2], 0.5, 1e-5);
  EXPECT_NEAR(first[3], 0.2, 1e-5);
  EXPECT_NEAR(second[0] - first[0], 2, 1e-9);      // two seconds a pair
  EXPECT_NEAR(second[1] - first[1], 0.008, 1e-5);  // 25 steps of 8 mm
  // the map begins on the table below the camera
  EXPECT_NEAR(numbers_of(estimate[0])[1], 0, 1e-9);
  EXPECT_NEAR(numbers_of(estimate[0])[3], 0.2, 1e-9);
  EXPECT_TRUE(std::filesystem::exists(small + "/figures/paper_figures.png"));
  EXPECT_THAT(text_of(small + "/report.html"), HasSubstr("The paper's five figures"));

  const auto metric = [](const std::string& folder, const char* name) {
    return json::parse(text_of(folder + "/metrics.json"))[name].get<double>();
  };
  const double ate_small_m = metric(small, "trajectory.ate_rmse_m"),
               ate_large_m = metric(large, "trajectory.ate_rmse_m");
  EXPECT_EQ(metric(small, "trajectory.lost_frames"), 0);
  EXPECT_LT(ate_small_m, 1e-3);
  EXPECT_NEAR(metric(large, "trajectory.length_m") / metric(small, "trajectory.length_m"), 4.4, 1e-3);
  EXPECT_NEAR(std::log(ate_large_m / ate_small_m / 4.4), 0, 0.3);
  EXPECT_NEAR(metric(large, "map.f1"), metric(small, "map.f1"), 0.03);
  EXPECT_THAT(text_of(small + "/map.yaml"), HasSubstr("resolution: 0.01136"));
  EXPECT_THAT(text_of(large + "/map.yaml"), HasSubstr("resolution: 0.05"));
}

TEST(ArmRun, ValidateNamesEveryStopOutOfReach) {
  const Workspace workspace;
  const std::string models = std::filesystem::absolute("models").string();
  const std::string file = workspace.write(
      "far.yaml",
      "format: 1\nname: far\nworld: " + models + "/worlds/tabletop.xml\nrobot: {model: " + models +
          "/robots/ur5e_xc55.xml}\nhead: {model: " + models +
          "/heads/xc55_20mm.yaml}\nplan:\n  speed_mps: 0.1\n  poses:\n    - {x_m: 0.4, y_m: 0.1, z_m: 0.2}\n"
          "    - {x_m: 1.0, y_m: 0.1, z_m: 0.2}\n    - {x_m: 0.4, y_m: 0.1, z_m: 0.01}\n");
  const Answer answer = groundloop({"validate", file});
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr(file + ":10: plan.poses[1]: x 1.000 m, y 0.100 m, z 0.200 m: "));
  EXPECT_THAT(
      answer.err,
      HasSubstr("mm beyond the arm's reach: wanted a place and a look direction that the arm can reach"));
  EXPECT_THAT(answer.err, HasSubstr(file + ":11: plan.poses[2]: x 0.400 m, y 0.100 m, z 0.010 m: "));
  EXPECT_THAT(answer.err,
              HasSubstr(" touches table: wanted a pose at which the arm stays 0.005 m clear of everything"));
}

}  // namespace
}  // namespace groundloop::bench
