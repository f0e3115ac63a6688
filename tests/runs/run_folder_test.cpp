// A short run through the laboratory, by the program itself.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/runs/program.h"

namespace groundloop::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::SizeIs;
using testing::StartsWith;

TEST(RunFolder, IsCompleteAndAgreesWithItself) {
  const Workspace workspace;
  const std::string folder = workspace.path("run");
  const Answer answer = groundloop({"run", "scenarios/smoke.yaml", "--frames", "12", "--out", folder});
  ASSERT_EQ(answer.exit_code, 0) << answer.out << answer.err;
  EXPECT_THAT(answer.out, StartsWith("smoke seed 1: pass  ATE 0.0"));
  EXPECT_THAT(answer.out, HasSubstr("\n  " + folder + "/report.html\n"));
  EXPECT_EQ(answer.complaint(), "");
  EXPECT_THAT(answer.err, StartsWith("smoke-1: OSMesa, llvmpipe"));
  EXPECT_THAT(answer.err, HasSubstr(", 4 samples a pixel, x86-64 "));
  EXPECT_THAT(answer.err, HasSubstr(", profile standard\n"));

  // every file of docs/architecture.md, and no leavings
  EXPECT_THAT(
      workspace.entries("run"),
      IsSupersetOf({"run.json", "scenario.yaml", "truth.tum", "estimate.tum", "keyframes.csv", "odometry.tum",
                    "cloud.ply", "map.pgm", "map.yaml", "map3d/map.bt", "truth_map.pgm", "truth_map.yaml",
                    "frames.csv", "metrics.json", "report.html", "figures/left_tracked.png",
                    "figures/disparity.png", "figures/top_view.png", "figures/map.png"}));
  for (const std::string& name : workspace.entries()) {
    EXPECT_THAT(name, testing::Not(
                          testing::AnyOf(HasSubstr("unfinished"), HasSubstr("replaced"), HasSubstr(".tmp"))));
    if (std::filesystem::is_regular_file(workspace.path(name))) {
      EXPECT_GT(std::filesystem::file_size(workspace.path(name)), 0u) << name;
    }
  }

  // one row a frame everywhere
  EXPECT_THAT(lines_of(folder + "/frames.csv"), SizeIs(13));
  for (const char* trajectory : {"/truth.tum", "/estimate.tum", "/odometry.tum"}) {
    EXPECT_THAT(lines_of(folder + trajectory), SizeIs(12)) << trajectory;
  }
  EXPECT_THAT(lines_of(folder + "/frames.csv")[0],
              StartsWith("index,stamp_ns,status,segment,is_key_frame,features_tracked,inliers,residual_px,"
                         "right_late_s,pyramid_ms,"));

  // metrics and verdict
  const json metrics = json::parse(text_of(folder + "/metrics.json"));
  for (const char* name : {"trajectory.ate_rmse_m",
                           "trajectory.ate_max_m",
                           "trajectory.end_error_m",
                           "trajectory.end_yaw_deg",
                           "trajectory.length_m",
                           "trajectory.lost_frames",
                           "trajectory.completeness",
                           "map.f1",
                           "map.iou",
                           "map.recall",
                           "map.brier",
                           "map.with_true_poses.f1",
                           "stage.disparity_rmse_px",
                           "stage.stereo_outlier_fraction",
                           "stage.track_rmse_px",
                           "stage.track_outlier_fraction",
                           "stage.point_rmse_m",
                           "tracking.interruptions",
                           "tracking.silent_jumps",
                           "tracking.row_offset_px",
                           "tracking.right_late_s",
                           "timing.render_ms",
                           "timing.slam_ms_median",
                           "timing.slam_ms_p99",
                           "timing.keyframe_ms_median",
                           "timing.wall_s",
                           "timing.realtime_factor",
                           "peak_memory_mb"}) {
    ASSERT_TRUE(metrics.contains(name)) << name;
    EXPECT_TRUE(metrics[name].is_number()) << name;
  }
  EXPECT_EQ(metrics["trajectory.lost_frames"], 0);
  EXPECT_EQ(metrics["tracking.interruptions"], 0);
  EXPECT_FALSE(metrics.contains("tracking.relocalised_s"));
  EXPECT_FALSE(metrics.contains("loop.precision"));  // no links, and nothing is seen again
  EXPECT_FALSE(metrics.contains("loop.recall"));
  EXPECT_EQ(metrics["trajectory.completeness"], 1);
  EXPECT_LT(metrics["trajectory.ate_rmse_m"], 0.02);
  EXPECT_NEAR(metrics["trajectory.length_m"], 0.21, 0.03);  // 11 intervals at 7.5 Hz and up to 0.18 m/s
  EXPECT_LT(metrics["stage.track_outlier_fraction"], 0.1);

  const json header = json::parse(text_of(folder + "/run.json"));
  EXPECT_EQ(header["name"], "smoke");
  EXPECT_FALSE(header.contains("oracles"));
  EXPECT_EQ(header["seed"], 1);
  EXPECT_EQ(header["frames"], 12);
  EXPECT_EQ(header["verdict"]["result"], "pass");
  EXPECT_EQ(header["renderer"]["backend"], "OSMesa");
  for (const char* input : {"scenario", "world", "robot", "head"}) {
    EXPECT_THAT(header["hashes"][input].get<std::string>(), SizeIs(64));
  }

  // the trajectories in the folder give the same error by another way
  const Answer eval = groundloop(
      {"eval", "--json", "--truth", folder + "/truth.tum", "--estimate", folder + "/estimate.tum"});
  ASSERT_EQ(eval.exit_code, 0) << eval.err;
  EXPECT_NEAR(json::parse(eval.out)["ape"]["rmse"], metrics["trajectory.ate_rmse_m"], 1e-6);

  // the resolved scenario is a scenario: the same one
  const Answer valid = groundloop({"validate", folder + "/scenario.yaml"});
  EXPECT_EQ(valid.exit_code, 0) << valid.err;

  // and the report shows everything without a network
  const std::string report = text_of(folder + "/report.html");
  EXPECT_THAT(report, HasSubstr("trajectory.ate_rmse_m"));
  EXPECT_THAT(report, HasSubstr("data:image/png;base64,"));
  for (const char* link : {"src=\"http", "href=\"http", "url(http"}) {
    EXPECT_EQ(report.find(link), std::string::npos) << link;
  }
}

}  // namespace
}  // namespace groundloop::bench
