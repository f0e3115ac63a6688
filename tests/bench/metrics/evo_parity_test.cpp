// Compares every number with evo's own, computed by evo on public trajectories that are not part of this
// project.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/metrics/alignment.h"
#include "bench/metrics/pose_error.h"
#include "bench/metrics/statistics.h"
#include "bench/metrics/trajectory_file.h"

namespace groundloop::bench {
namespace {

constexpr double kTolerance = 1e-9;  // relative above 1, absolute below

template <class E>
E named(const std::string& name) {
  for (const auto& [value, known] : EnumNames<E>::names) {
    if (name == known) return value;
  }
  throw std::runtime_error("no such name: " + name);
}

/// An evo command line, read the way evo's own parser reads it.
struct EvoCommand {
  bool relative = false;
  TrajectoryFormat format = TrajectoryFormat::kTum;
  std::string truth, estimate;
  bool align = false, correct_scale = false, align_origin = false;
  std::optional<size_t> n_to_align;
  AssociationOptions association;
  RelativeOptions options;
};

EvoCommand parsed(const std::string& line) {
  std::istringstream words(line);
  EvoCommand command;
  std::string program, format, word;
  words >> program >> format >> command.truth >> command.estimate;
  command.relative = program == "evo_rpe";
  command.format = named<TrajectoryFormat>(format);
  while (words >> word) {
    if (word == "-a" || word == "-as") command.align = true;
    if (word == "-s" || word == "-as") command.correct_scale = true;
    if (word == "--align_origin") command.align_origin = true;
    if (word == "--all_pairs") command.options.all_pairs = true;
    if (word == "--pairs_from_reference") command.options.pairs_from_reference = true;
    if (word == "--n_to_align") words >> command.n_to_align.emplace();
    if (word == "--t_max_diff") words >> command.association.max_difference_s;
    if (word == "--t_offset") words >> command.association.offset_s;
    if (word == "-d") words >> command.options.delta;
    if (word == "-r" && words >> word) command.options.relation = named<PoseRelation>(word);
    if (word == "-u" && words >> word) command.options.unit = named<DeltaUnit>(word);
  }
  return command;
}

AlignMode mode_of(const EvoCommand& command) {
  if (command.align_origin) return AlignMode::kOrigin;
  if (command.align) return command.correct_scale ? AlignMode::kSim3 : AlignMode::kSe3;
  return command.correct_scale ? AlignMode::kScale : AlignMode::kNone;
}

std::vector<double> errors_of(const EvoCommand& command, const std::string& folder) {
  const auto estimate_format =
      command.format == TrajectoryFormat::kEuroc ? TrajectoryFormat::kTum : command.format;
  const TrajectoryFile truth = read_trajectory(folder + "/" + command.truth, command.format);
  const TrajectoryFile estimate = read_trajectory(folder + "/" + command.estimate, estimate_format);
  PosePairs pairs = command.format == TrajectoryFormat::kKitti
                        ? PosePairs{truth.poses, estimate.poses}
                        : associate_by_time(truth.poses, estimate.poses, command.association);
  align(pairs, mode_of(command), command.n_to_align);
  return command.relative ? relative_errors(pairs, command.options)
                          : absolute_errors(pairs, command.options.relation);
}

std::string data_folder() {
  const char* named_folder = std::getenv("GROUNDLOOP_DATA");
  return (named_folder ? std::string(named_folder) : "../shared/data") + "/evo";
}

TEST(EvoParity, EveryRecordedCommandGivesEvosNumbers) {
  std::ifstream reference(data_folder() + "/evo_reference_numbers.jsonl");
  if (!reference) GTEST_SKIP() << "no recorded data in " << data_folder();
  std::string line;
  int commands = 0;
  double worst = 0;
  while (std::getline(reference, line)) {
    const auto entry = nlohmann::json::parse(line);
    SCOPED_TRACE(entry.at("cmd").get<std::string>());
    const std::vector<double> errors = errors_of(parsed(entry.at("cmd")), data_folder());
    EXPECT_EQ(errors.size(), entry.at("n").get<size_t>());
    const Statistics s = statistics(errors);
    const std::map<std::string, double> ours = {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median},
                                                {"std", s.std},   {"min", s.min},   {"max", s.max},
                                                {"sse", s.sse}};
    ASSERT_EQ(entry.at("stats").size(), ours.size());
    for (const auto& [name, value] : ours) {
      const double evo = entry.at("stats").at(name);
      const double difference = std::abs(value - evo) / std::max(1.0, std::abs(evo));
      EXPECT_LE(difference, kTolerance) << name << ": " << value << " here, " << evo << " by evo";
      worst = std::max(worst, difference);
    }
    ++commands;
  }
  EXPECT_EQ(commands, 109);
  RecordProperty("largest_difference", std::to_string(worst));
  std::cout << commands << " commands, largest difference " << worst << "\n";
}

}  // namespace
}  // namespace groundloop::bench
