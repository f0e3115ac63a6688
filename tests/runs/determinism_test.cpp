// The same scenario and seed give the same bytes, alone or beside another run; timings are the only
// exception.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/report/report.h"
#include "tests/runs/program.h"

namespace groundloop::bench {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

bool is_timing_column(const std::string& name) { return name.ends_with("_ms") || name == "memory_mb"; }
bool is_timing_metric(const std::string& name) {
  return name.starts_with("timing.") || name == "peak_memory_mb";
}

/// frames.csv without the columns of milliseconds and megabytes.
std::string frames_without_timings(const fs::path& file) {
  const std::vector<std::string> lines = lines_of(file);
  const std::vector<std::string> names = cells_of(lines.at(0));
  std::string text;
  int timings = 0;
  for (const std::string& line : lines) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), names.size());
    for (size_t i = 0; i < cells.size(); ++i) {
      if (!is_timing_column(names[i])) text += cells[i] + ",";
      timings += is_timing_column(names[i]);
    }
    text += "\n";
  }
  EXPECT_GT(timings, 0);
  return text;
}

std::string metrics_without_timings(const fs::path& file) {
  json metrics = json::parse(text_of(file));
  for (auto it = metrics.begin(); it != metrics.end();) {
    it = is_timing_metric(it.key()) ? metrics.erase(it) : std::next(it);
  }
  return metrics.dump(1);
}

/// Byte for byte, but for timings. The report is made of the folder alone: with one run's timings in the
/// other's folder, both reports must be the same.
void expect_same_run(const fs::path& a, const fs::path& b, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (fs::is_directory(a / name) || name == "report.html") continue;
    if (name == "frames.csv") {
      EXPECT_EQ(frames_without_timings(a / name), frames_without_timings(b / name)) << name;
    } else if (name == "metrics.json") {
      EXPECT_EQ(metrics_without_timings(a / name), metrics_without_timings(b / name)) << name;
    } else {
      EXPECT_TRUE(text_of(a / name) == text_of(b / name)) << name << " differs";
    }
  }
  for (const char* timed : {"frames.csv", "metrics.json"}) {
    fs::copy_file(a / timed, b / timed, fs::copy_options::overwrite_existing);
  }
  write_report(b.string());
  EXPECT_TRUE(text_of(a / "report.html") == text_of(b / "report.html")) << "report.html differs";
}

TEST(Determinism, RunsAreTheSameBytesForAnyNumberOfJobs) {
  const Workspace workspace;
  for (const std::string jobs : {"1", "2"}) {
    const Answer answer = groundloop({"run", "scenarios/smoke.yaml", "--seed", "1..2", "--frames", "8",
                                      "--jobs", jobs, "--out", workspace.path("jobs" + jobs)});
    ASSERT_EQ(answer.exit_code, 0) << answer.out << answer.err;
  }
  const std::vector<std::string> names = workspace.entries("jobs1");
  EXPECT_EQ(names, workspace.entries("jobs2"));
  EXPECT_GT(names.size(), 40u);
  for (const char* run : {"smoke-1", "smoke-2"}) {
    expect_same_run(workspace.path("jobs1/" + std::string(run)), workspace.path("jobs2/" + std::string(run)),
                    workspace.entries("jobs1/" + std::string(run)));
  }
  // Another seed is another run.
  EXPECT_NE(frames_without_timings(workspace.path("jobs1/smoke-1/frames.csv")),
            frames_without_timings(workspace.path("jobs1/smoke-2/frames.csv")));
}

}  // namespace
}  // namespace groundloop::bench
