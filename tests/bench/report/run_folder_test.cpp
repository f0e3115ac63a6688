#include "bench/report/run_folder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "slam/types/config.h"
#include "tests/bench/report/synthetic_run.h"
#include "tests/bench/report/temporary_folder.h"

namespace groundloop::bench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string message_of(const std::string& dir) {
  try {
    load_run_folder(dir);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RunFolder, GivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  SyntheticRun::write(folder.path());
  const RunFolder run = load_run_folder(folder.path());

  EXPECT_EQ(run.header.name, "synthetic_circle");
  EXPECT_EQ(run.header.seed, 7U);
  EXPECT_EQ(run.header.renderer.at("samples"), "4");
  EXPECT_EQ(run.header.result, "fell short");
  ASSERT_EQ(run.header.judged.size(), 2U);
  EXPECT_EQ(run.header.judged[0].max, 0.15);
  EXPECT_FALSE(run.header.judged[0].min.has_value());
  EXPECT_FALSE(run.header.judged[0].ok);

  ASSERT_EQ(run.truth.size(), static_cast<size_t>(SyntheticRun::kFrames));
  EXPECT_EQ(run.truth[17].stamp_ns, SyntheticRun::stamp_ns(17));
  EXPECT_TRUE(run.truth[17].T.isApprox(SyntheticRun::T_world_left(17), 1e-9));
  ASSERT_EQ(run.key_frames.size(), 50U);
  EXPECT_EQ(run.key_frames[2].index, 12);
  EXPECT_TRUE(run.key_frames[2].T_map_left.isApprox(SyntheticRun::T_map_left(12), 1e-9));
  ASSERT_TRUE(run.T_world_map.has_value());
  EXPECT_TRUE(run.T_world_map->isApprox(SyntheticRun::T_world_map(), 1e-5));

  EXPECT_EQ(run.frames.rows, static_cast<size_t>(SyntheticRun::kFrames));
  EXPECT_EQ(run.frames.status[SyntheticRun::kLostFrom], "lost");
  EXPECT_EQ(run.frames.column("inliers")[SyntheticRun::kLostFrom], 3);
  EXPECT_TRUE(run.frames.column("disparity_error_px").empty());
  EXPECT_EQ(run.metrics.at("trajectory.length_m"), 18.85);

  EXPECT_EQ(run.cloud.size(), 20000U);
  EXPECT_EQ(run.truth_map->value, SyntheticRun::exact_map().value);
  EXPECT_EQ(run.map->geometry.rows, 280);
  EXPECT_EQ(run.visible->value.size(), run.truth_map->value.size());
  ASSERT_EQ(run.outline.size(), 6U);
  EXPECT_EQ(run.outline[5].name, "cupboard <tall>");
  EXPECT_EQ(run.outline[4].polygon[2], Eigen::Vector2d(6.8, 4.4));
}

TEST(RunFolder, ReadsLinksAndOracles) {
  const TemporaryFolder folder;
  SyntheticRun::write(folder.path());
  SyntheticRun::add_links(folder.path());
  SyntheticRun::add_oracles(folder.path());
  const RunFolder run = load_run_folder(folder.path());
  ASSERT_EQ(run.links.size(), 3U);
  EXPECT_EQ(run.links[1].from_index, 8);
  EXPECT_EQ(run.links[1].to_index, 258);
  EXPECT_FALSE(run.links[1].wrong);
  EXPECT_TRUE(run.links[2].wrong);
  EXPECT_EQ(run.without_links.size(), static_cast<size_t>(SyntheticRun::kFrames));
  ASSERT_EQ(run.oracles.size(), 2U);
  EXPECT_EQ(run.oracles[1].exact, "tracking");
  EXPECT_EQ(run.oracles[1].outcome, "pass");
  EXPECT_EQ(run.oracles[1].metrics.at("trajectory.ate_rmse_m"), 0.1);
}

TEST(RunFolder, NeedsOnlyRunJson) {
  const TemporaryFolder folder;
  write_text(folder.path() + "/run.json", R"({"name": "bare", "verdict": {"result": "error"}})");
  const RunFolder run = load_run_folder(folder.path());
  EXPECT_EQ(run.header.name, "bare");
  EXPECT_TRUE(run.truth.empty());
  EXPECT_FALSE(run.map.has_value());
}

TEST(RunFolder, EmptyCellsAreNotNumbers) {
  const TemporaryFolder folder;
  write_text(folder.path() + "/run.json", synthetic_run_json("pass"));
  write_text(folder.path() + "/frames.csv", "stamp_ns,status,total_ms\r\n0,started,\r\n1,tracking,2.5\r\n");
  const RunFolder run = load_run_folder(folder.path());
  ASSERT_EQ(run.frames.rows, 2U);
  EXPECT_TRUE(std::isnan(run.frames.column("total_ms")[0]));
  EXPECT_EQ(run.frames.column("total_ms")[1], 2.5);
}

TEST(RunFolder, SaysWhatIsWrongAndWhere) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of(folder.path()), AllOf(HasSubstr("run.json"), HasSubstr("wanted a readable file")));

  write_text(folder.path() + "/run.json", R"({"name": "x"})");
  EXPECT_THAT(message_of(folder.path()), AllOf(HasSubstr("run.json"), HasSubstr("verdict")));

  write_text(folder.path() + "/run.json", synthetic_run_json("pass"));
  write_text(folder.path() + "/frames.csv", "stamp_ns,total_ms\n0,1\n1,soon\n");
  EXPECT_THAT(message_of(folder.path()), HasSubstr("frames.csv:3: total_ms: soon: wanted a number"));

  write_text(folder.path() + "/frames.csv", "stamp_ns,total_ms\n0\n");
  EXPECT_THAT(message_of(folder.path()), HasSubstr("frames.csv:2: 1 cells: wanted 2 cells"));

  std::filesystem::remove(folder.path() + "/frames.csv");
  write_text(folder.path() + "/keyframes.csv", "index\n0,0,0,1,2,3,0,0,0,2\n");
  EXPECT_THAT(message_of(folder.path()), HasSubstr("keyframes.csv:2: qx qy qz qw: wanted a unit quaternion"));

  std::filesystem::remove(folder.path() + "/keyframes.csv");
  write_text(folder.path() + "/links.csv", "kind\nlandmarks,1,2\n");
  EXPECT_THAT(message_of(folder.path()), HasSubstr("links.csv:2: landmarks,1,2: wanted 16 cells"));
  std::filesystem::remove(folder.path() + "/links.csv");
  write_text(folder.path() + "/oracles.json", R"([{"exact": "tracking"}])");
  EXPECT_THAT(message_of(folder.path()),
              AllOf(HasSubstr("oracles.json"), HasSubstr("a list of {exact, outcome, metrics}")));
  std::filesystem::remove(folder.path() + "/oracles.json");
  write_text(folder.path() + "/alignment.json", R"({"T_world_map": [1, 2]})");
  EXPECT_THAT(message_of(folder.path()),
              AllOf(HasSubstr("alignment.json"), HasSubstr("T_world_map: 16 numbers")));
}

}  // namespace
}  // namespace groundloop::bench
