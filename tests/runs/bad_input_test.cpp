// One clear line for every wrong input, exit code 2, and no run folder; and runs that are meant to fail.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/runs/program.h"

namespace groundloop::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;

const std::string kWorld =
    "<mujoco><worldbody><light pos='0 0 3' dir='0 0 -1' directional='true'/>"
    "<geom name='floor' type='plane' size='10 10 0.1' rgba='0.5 0.5 0.5 1'/>";
const std::string kEnd = "</worldbody></mujoco>";

/// Scenarios around a room of their own, grey and empty but for what a test puts in.
class SmallRoom : public testing::Test {
 protected:
  SmallRoom() { workspace_.write("empty.xml", kWorld + kEnd); }

  /// @param more  further lines
  std::string scenario(const std::string& world, const std::string& more = "", double straight_m = 0.3) {
    const std::string models = fs::absolute("models").string();
    return workspace_.write("small.yaml", "format: 1\nname: small\nworld: " + world + "\nrobot: {model: " +
                                              models + "/robots/p3dx.xml}\nhead: {model: " + models +
                                              "/heads/sth_mdcs.yaml}\nplan:\n  speed_mps: 0.2\n  segments:\n"
                                              "    - {straight_m: " +
                                              std::to_string(straight_m) + "}\n" + more);
  }
  Answer run(const std::string& file, const std::string& out = "run") {
    return groundloop({"run", file, "--frames", "5", "--out", workspace_.path(out)});
  }
  void expect_refused(const Answer& answer, const std::string& message) {
    EXPECT_EQ(answer.exit_code, 2);
    EXPECT_EQ(answer.err, message + "\n");
    EXPECT_FALSE(fs::exists(workspace_.path("run")));
  }

  const Workspace workspace_;
};

TEST_F(SmallRoom, AMissingTextureIsNamed) {
  workspace_.write("brick.xml",
                   "<mujoco><asset>\n<texture name='brick' type='2d' file='brick.png'/></asset>" +
                       kWorld.substr(8) + kEnd);
  expect_refused(run(scenario("brick.xml")), workspace_.path("brick.xml") + ":2: texture 'brick': " +
                                                 workspace_.path("brick.png") + ": wanted an existing file");
}

TEST_F(SmallRoom, AWrongKeyIsNamedWithTheRightOne) {
  const std::string file = scenario("empty.xml", "sed: 4\n");
  const Answer answer = run(file);
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err,
              MatchesRegex(file + ":10: sed: unknown key: wanted one of: .* \\(did you mean seed\\?\\)\n"));
  EXPECT_FALSE(fs::exists(workspace_.path("run")));
}

TEST_F(SmallRoom, AWrongOptionOfTheCoreIsNamedWithItsLine) {
  const std::string file = scenario("empty.xml", "slam: {set: {tracking.max_features: 3}}\n");
  expect_refused(run(file), file + ":10: tracking.max_features: 3: wanted a whole number from 20 to 5000");
}

TEST_F(SmallRoom, APathThroughADeskIsRefused) {
  workspace_.write("desk.xml",
                   kWorld + "<geom name='desk' type='box' pos='2.5 0 0.3' size='0.5 0.5 0.3'/>" + kEnd);
  const std::string file = scenario("desk.xml", "", 2);
  expect_refused(run(file),
                 file +
                     ":9: plan.segments[0]: touches desk at x 1.80 m, y 0.00 m: wanted a place 0.03 m "
                     "clear of everything");
}

TEST_F(SmallRoom, AnOutThatCannotBeWrittenIsNamed) {
  const std::string file = scenario("empty.xml");
  const std::string in_file = workspace_.write("file", "text");
  expect_refused(run(file, "file/run"),
                 "--out: " + in_file + "/run: Not a directory: wanted a folder that can be written");
  expect_refused(run(file, "file"), "--out: " + in_file + ": is a file: wanted a folder to write the run to");
  EXPECT_EQ(text_of(in_file), "text");

  fs::create_directories(workspace_.path("other"));
  workspace_.write("other/mine", "text");
  expect_refused(run(file, "other"),
                 "--out: " + workspace_.path("other") +
                     ": holds something that is not a run: wanted a new folder, or an older run "
                     "to replace");
  EXPECT_EQ(text_of(workspace_.path("other/mine")), "text");
}

TEST_F(SmallRoom, AMissingWorldIsNamed) {
  const Answer answer = run(scenario("absent.xml"));
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr("absent.xml"));
  EXPECT_THAT(answer.err, MatchesRegex("[^\n]*: wanted [^\n]*\n"));  // one line
}

TEST_F(SmallRoom, NothingToSeeFallsShortUnlessThatIsExpected) {
  const Answer unexpected = run(scenario("empty.xml"));
  EXPECT_EQ(unexpected.exit_code, 1);
  EXPECT_THAT(unexpected.out,
              MatchesRegex("small seed 1: fell short .*\n  trajectory.lost_frames is [1-5], expected at "
                           "most 0\n  .*/run/report.html\n"));
  nlohmann::json header = nlohmann::json::parse(text_of(workspace_.path("run/run.json")));
  EXPECT_EQ(header["verdict"]["result"], "fell short");

  // The next run takes the place of the older one.
  const Answer expected = run(scenario("empty.xml", "expect: {outcome: lost}\n"));
  EXPECT_EQ(expected.exit_code, 0) << expected.out << expected.err;
  EXPECT_THAT(expected.out, testing::StartsWith("small seed 1: pass"));
  header = nlohmann::json::parse(text_of(workspace_.path("run/run.json")));
  EXPECT_EQ(header["verdict"]["result"], "pass");
  for (const std::string& name : workspace_.entries()) EXPECT_THAT(name, testing::Not(HasSubstr("replaced")));
}

TEST(ExpectedFailure, FallsShortWhenNothingIsLost) {
  const Workspace workspace;
  std::string text = text_of("scenarios/smoke.yaml");
  const std::string models = fs::absolute("models").string();
  for (size_t at = text.find("../models"); at != std::string::npos; at = text.find("../models")) {
    text.replace(at, 9, models);
  }
  text.resize(text.find("expect:"));
  const std::string file = workspace.write("smoke.yaml", text + "expect: {outcome: lost}\n");
  const Answer answer = groundloop({"run", file, "--frames", "4", "--out", workspace.path("run")});
  EXPECT_EQ(answer.exit_code, 1) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("trajectory.lost_frames is 0, expected at least 1"));
}

}  // namespace
}  // namespace groundloop::bench
