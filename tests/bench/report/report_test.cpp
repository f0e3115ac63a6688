#include "bench/report/report.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "bench/report/report_tables.h"
#include "bench/report/run_series.h"
#include "slam/types/config.h"
#include "tests/bench/report/synthetic_run.h"
#include "tests/bench/report/temporary_folder.h"

namespace groundloop::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string read(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

size_t count(const std::string& text, const std::string& what) {
  size_t found = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST(Report, OfACompleteRunShowsEverything) {
  const TemporaryFolder folder;
  SyntheticRun::write(folder.path());
  const std::string file = write_report(folder.path());
  EXPECT_EQ(file, folder.path() + "/report.html");
  const std::string html = read(file);

  EXPECT_LT(html.size(), 5'000'000U);
  EXPECT_THAT(html, HasSubstr("Fell short:</strong> 1 of 2 expectations do not hold."));
  EXPECT_THAT(html, HasSubstr("trajectory.ate_rmse_m is 0.25\u00a0m, wanted at most 0.15\u00a0m"));
  EXPECT_LT(html.find("Fell short"), html.find("<img")) << "the verdict comes first";
  EXPECT_EQ(count(html, "<img "), 7U);
  EXPECT_EQ(count(html, "<img "), count(html, "src=\"data:image/"));
  EXPECT_EQ(count(html, "<img "), count(html, " alt=\""));
  EXPECT_EQ(count(html, "<svg "), 5U);
  for (const char* figure : {"Fig. 1", "Fig. 2", "Fig. 3", "Fig. 4", "Fig. 5"})
    EXPECT_THAT(html, HasSubstr(figure));
  EXPECT_THAT(html, Not(HasSubstr("class=\"note\"")));
  for (const char* network : {"http:", "https:", "<script", "<link", "@import"}) {
    EXPECT_THAT(html, Not(HasSubstr(network)));
  }
  for (const char* made : {"top_view.png", "map.png", "map_difference.png", "paper_figures.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() + "/figures/" + made)) << made;
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    EXPECT_NE(entry.path().extension(), ".partial");
  }
  EXPECT_EQ(read(write_report(folder.path())), html) << "an old run reported again";
}

TEST(Report, ShowsLinksAndWhatTheyChanged) {
  const TemporaryFolder folder;
  SyntheticRun::write(folder.path());
  EXPECT_THAT(read(write_report(folder.path())), Not(HasSubstr("Violet")));
  SyntheticRun::add_links(folder.path());
  const std::string html = read(write_report(folder.path()));
  EXPECT_THAT(html, HasSubstr("Violet: from where a place was seen first"));
  EXPECT_THAT(html, HasSubstr("Orange: the estimate, had no place been recognised."));
  const PlacedRun place = placed(load_run_folder(folder.path()));
  ASSERT_EQ(place.view.links.size(), 3U);
  const Eigen::Vector3d raised(0, 0, SyntheticRun::kError_m);
  EXPECT_TRUE(place.view.links[0].to.isApprox(SyntheticRun::T_world_left(250).translation() + raised, 1e-9));
  EXPECT_TRUE(place.view.links[2].wrong);
}

TEST(Report, OfAStudyShowsEachStagesPart) {
  const TemporaryFolder folder;
  SyntheticRun::write(folder.path());
  EXPECT_THAT(read(write_report(folder.path())), Not(HasSubstr("Each stage's part")));
  SyntheticRun::add_oracles(folder.path());
  const std::string html = read(write_report(folder.path()));
  EXPECT_THAT(html, HasSubstr("Each stage's part of the error"));
  EXPECT_THAT(html, HasSubstr("<td class=\"n\">0.1\u00a0m<small>-60 %</small></td><td>pass</td>"));
}

TEST(Report, OfARunWithAnOracleSaysSoFirst) {
  const TemporaryFolder folder;
  std::string run = synthetic_run_json("pass");
  run.replace(run.find("\"preset\""), 0, "\"oracles\": \"tracking+stereo\", ");
  write_text(folder.path() + "/run.json", run);
  const std::string html = read(write_report(folder.path()));
  const size_t said = html.find("exact answers in the place of tracking+stereo; not a result of the SLAM");
  ASSERT_NE(said, std::string::npos);
  EXPECT_LT(said, html.find("Pass:"));
}

TEST(Report, OfABareRunSaysWhatIsMissing) {
  const TemporaryFolder folder;
  write_text(folder.path() + "/run.json",
             R"({"name": "<script>alert(1)</script>", "summary": "a & b", "kind": "replay", "frames": 3,
"verdict": {"result": "pass", "lines": []}})");
  const std::string html = read(write_report(folder.path()));
  EXPECT_THAT(html, HasSubstr("Pass:</strong> nothing was expected of this run."));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, HasSubstr("a &amp; b"));
  EXPECT_THAT(html, HasSubstr("The run left no occupancy map."));
  EXPECT_THAT(html, HasSubstr("Without a true trajectory there are no errors over time."));
  EXPECT_EQ(count(html, "<img "), 0U);
}

TEST(Report, OfAReplayStaysInTheMapFrame) {
  const TemporaryFolder folder;
  SyntheticRun::write(folder.path());
  std::string run = synthetic_run_json("pass");
  run.replace(run.find("\"run\""), 5, "\"replay\"");
  write_text(folder.path() + "/run.json", run);
  std::filesystem::remove(folder.path() + "/truth_map.yaml");
  const std::string html = read(write_report(folder.path()));
  EXPECT_THAT(html, HasSubstr("replay of a recorded sequence"));
  EXPECT_THAT(html, HasSubstr("No exact map is known"));
  const PlacedRun place = placed(load_run_folder(folder.path()));
  EXPECT_TRUE(place.view.estimate[9].T.isApprox(SyntheticRun::T_map_left(9), 1e-9));
  EXPECT_TRUE(place.view.outline.empty());
  EXPECT_NEAR(error_series(place.view, 0).position_m[9], SyntheticRun::kError_m, 1e-5);
}

TEST(Report, CannotBeWrittenIntoNothing) {
  const TemporaryFolder folder;
  try {
    write_report(folder.path() + "/absent");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent/run.json"));
  }
}

TEST(RunSeries, ErrorsAreThoseThatWerePutIn) {
  const TemporaryFolder folder;
  SyntheticRun::write(folder.path());
  const RunFolder run = load_run_folder(folder.path());
  const ErrorSeries errors = error_series(placed(run).view, first_stamp_ns(run));
  ASSERT_EQ(errors.t_s.size(), static_cast<size_t>(SyntheticRun::kFrames));
  EXPECT_NEAR(errors.t_s[30], 3.99999999, 1e-9);
  for (size_t i = 0; i < errors.t_s.size(); ++i) {
    EXPECT_NEAR(errors.position_m[i], SyntheticRun::kError_m, 1e-5);
    EXPECT_NEAR(errors.yaw_deg[i], 0, 1e-3);
  }
  const auto lost = lost_spans_s(run.frames);
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_NEAR(lost[0].first, SyntheticRun::kLostFrom * 0.133333333, 1e-9);
  EXPECT_NEAR(lost[0].second, SyntheticRun::kLostTo * 0.133333333, 1e-9);
}

TEST(RunSeries, PercentilesAreInterpolated) {
  EXPECT_DOUBLE_EQ(percentile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(percentile({4, 1, std::nan(""), 3, 2}, 1), 4);
  EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
}

TEST(ReportTables, UnitsComeFromTheName) {
  EXPECT_EQ(value_with_unit("trajectory.ate_rmse_m", 0.07213), "0.07213\u00a0m");
  EXPECT_EQ(value_with_unit("trajectory.ate_rmse_m", 0.07213, 3), "0.0721\u00a0m");
  EXPECT_EQ(value_with_unit("trajectory.rpe_rot_deg_per_m", 0.5), "0.5\u00a0°/m");
  EXPECT_EQ(value_with_unit("trajectory.end_yaw_deg", 2), "2°");
  EXPECT_EQ(value_with_unit("map.false_free_m2", 1.25), "1.25\u00a0m²");
  EXPECT_EQ(value_with_unit("timing.slam_ms_median", 5.25), "5.25\u00a0ms");
  EXPECT_EQ(value_with_unit("map.wall_offset_p95_m", 0.1), "0.1\u00a0m");
  EXPECT_EQ(value_with_unit("stage.track_rmse_px", 0.125), "0.125\u00a0px");
  EXPECT_EQ(value_with_unit("trajectory.lost_frames", 0), "0");
  EXPECT_EQ(value_with_unit("map.f1", 0.87), "0.87");
}

TEST(ReportTables, SentencesNameMetricValueAndBound) {
  EXPECT_EQ(judged_sentence({"map.f1", 0.5, 0.6, std::nullopt, false}), "map.f1 is 0.5, wanted at least 0.6");
  EXPECT_EQ(judged_sentence({"map.f1", std::nullopt, 0.6, 0.9, false}),
            "map.f1 was not measured, wanted 0.6 to 0.9");
}

TEST(ReportTables, StagesThatWereNotMeasuredAreLeftOut) {
  FrameTable frames;
  EXPECT_EQ(stage_table(frames), "");
  frames.rows = 3;
  frames.columns["tracking_ms"] = {1, 2, 3};
  frames.columns["total_ms"] = {4, 4, 4};
  const std::string html = stage_table(frames);
  EXPECT_THAT(html, HasSubstr("tracking"));
  EXPECT_THAT(html, HasSubstr("2.00"));
  EXPECT_THAT(html, HasSubstr("50 %"));
  EXPECT_THAT(html, Not(HasSubstr("mapping")));
}

}  // namespace
}  // namespace groundloop::bench
