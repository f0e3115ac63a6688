// The truth wall: nothing in slam/ knows of the simulator, the bench, or the libraries that hold the truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/house/tree.h"

namespace groundloop {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// What an #include line names, when slam/ must not name it.
std::vector<std::string> forbidden_includes(const std::string& source) {
  static const std::regex include(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  static const std::regex forbidden(
      R"re((^|/)(mujoco|mj\w+|GL|EGL|OSMesa|osmesa|bullet|LinearMath|BulletCollision|BulletDynamics|bt\w+)(/|\.h|$))re",
      std::regex::icase);
  std::vector<std::string> found;
  std::istringstream lines(source);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (!std::regex_search(line, match, include)) continue;
    const std::string name = match[2];
    const bool own = match[1] == "\"";  // quotes are the project's own headers: only those of slam/
    if ((own && !name.starts_with("slam/")) || name.starts_with("sim/") || name.starts_with("bench/") ||
        std::regex_search(name, forbidden)) {
      found.push_back(name);
    }
  }
  return found;
}

/// Targets and libraries in a line of link names that slam/ must not link.
std::vector<std::string> forbidden_links(const std::string& closure) {
  static const std::regex forbidden(
      "^(sim|bench)_|mujoco|osmesa|bullet|LinearMath|(^|::|lib|-l)(GL|EGL|OpenGL)(\\.|$)", std::regex::icase);
  std::vector<std::string> found;
  std::istringstream names(closure);
  for (std::string name; names >> name;) {
    if (std::regex_search(name, forbidden)) found.push_back(name);
  }
  return found;
}

TEST(TruthWall, NoFileOfSlamIncludesWhatMakesOrJudgesTheTruth) {
  const auto files = tree_files("slam", {".h", ".cpp"});
  ASSERT_GT(files.size(), 10U);
  for (const auto& file : files) EXPECT_THAT(forbidden_includes(tree_text(file)), IsEmpty()) << file;
}

TEST(TruthWall, NoTargetOfSlamLinksWhatMakesOrJudgesTheTruth) {
  std::ifstream links(SLAM_LINKS);
  ASSERT_TRUE(links) << SLAM_LINKS;
  int targets = 0;
  for (std::string closure; std::getline(links, closure); ++targets) {
    ASSERT_TRUE(closure.starts_with("slam_")) << closure;
    EXPECT_THAT(closure, testing::HasSubstr("groundloop_base")) << "the walk over link names is broken";
    EXPECT_THAT(forbidden_links(closure), IsEmpty()) << closure;
  }
  EXPECT_GE(targets, 8) << "types, source, features, stereo, tracking, registration, mapping, pipeline";
}

TEST(TruthWall, TheRulesSeeAViolation) {
  EXPECT_THAT(
      forbidden_includes("#include <vector>\n#include \"slam/types/pose.h\"\n#include <opencv2/core.hpp>\n"),
      IsEmpty());
  EXPECT_THAT(
      forbidden_includes("#include \"sim/truth/truth_world.h\"\n  #include <mujoco/mujoco.h>\n"
                         "#include <GL/osmesa.h>\n# include <bullet/btBulletCollisionCommon.h>\n"
                         "#include \"bench/metrics/trajectory.h\"\n#include \"../sim/world/world.h\"\n"),
      ElementsAre("sim/truth/truth_world.h", "mujoco/mujoco.h", "GL/osmesa.h",
                  "bullet/btBulletCollisionCommon.h", "bench/metrics/trajectory.h", "../sim/world/world.h"));
  EXPECT_THAT(
      forbidden_links("slam_stereo groundloop_base opencv_core Eigen3::Eigen Threads::Threads yaml-cpp"),
      IsEmpty());
  EXPECT_THAT(
      forbidden_links("slam_stereo sim_truth mujoco /usr/lib/libOSMesa.so BulletCollision LinearMath GL "
                      "bench_metrics"),
      ElementsAre("sim_truth", "mujoco", "/usr/lib/libOSMesa.so", "BulletCollision", "LinearMath", "GL",
                  "bench_metrics"));
}

}  // namespace
}  // namespace groundloop
