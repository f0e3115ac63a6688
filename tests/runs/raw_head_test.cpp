// A raw head in the whole program: images with real lenses and sensors, rectified by the core, judged by the
// truth of the rectified camera.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "sim/head/head.h"
#include "slam/rectify/rectifier.h"
#include "tests/runs/program.h"

namespace groundloop::bench {
namespace {

using nlohmann::json;

/// The delivered raw head with fewer renderings, and exactly calibrated.
sim::HeadModel quick_head() {
  sim::HeadModel head = sim::load_head("models/heads/sth_mdcs_raw.yaml");
  head.raw->exposure.sub_frames = 2;
  head.raw->optics.supersampling = 1;
  head.raw->calibration_error = {};
  return head;
}

class RawHeadRun : public testing::Test {
 protected:
  /// Metrics of the first four pairs; files are in `folder`.
  json run(const std::string& folder) {
    const std::string head = workspace_.write(folder + ".yaml", to_yaml(quick_head()));
    const Answer answer = groundloop({"run", "scenarios/lab_raw_head.yaml", "--frames", "4", "--set",
                                      "head.model=" + head, "--out", workspace_.path(folder)});
    EXPECT_EQ(answer.exit_code, 0) << answer.out << answer.err;
    return json::parse(text_of(workspace_.path(folder + "/metrics.json")));
  }
  const Workspace workspace_;
};

TEST_F(RawHeadRun, IsAsExactAsItsCalibrationAndTheSameEveryTime) {
  const json exact = run("exact");
  // With the true calibration there is no more than the noise of the pixels; 0.07 m are driven.
  EXPECT_LT(exact.at("trajectory.ate_rmse_m"), 5e-4);
  EXPECT_LT(exact.at("stage.disparity_rmse_px"), 0.8);
  EXPECT_LT(exact.at("stage.stereo_outlier_fraction"), 0.1);

  run("again");
  for (const char* file : {"estimate.tum", "truth.tum", "cloud.ply", "calibration.yaml"}) {
    EXPECT_EQ(text_of(workspace_.path(std::string("exact/") + file)),
              text_of(workspace_.path(std::string("again/") + file)))
        << file;
  }

  // what the core was told is in the run folder, and is what it would make of its images
  const auto told = slam::read_stereo_calibration({workspace_.path("exact/calibration.yaml")});
  EXPECT_EQ(told.size.value(), cv::Size(640, 480));
  EXPECT_DOUBLE_EQ(told.M1(0, 0), quick_head().raw->optics.left.fx_px);

  // the settings of the automatic exposure are written down
  const std::vector<std::string> lines = lines_of(workspace_.path("exact/frames.csv"));
  EXPECT_THAT(lines.at(0), testing::HasSubstr(",exposure_s,gain_db,"));
  EXPECT_THAT(lines.at(1), testing::HasSubstr(",0.008,9,"));
}

}  // namespace
}  // namespace groundloop::bench
