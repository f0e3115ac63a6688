#include "bench/report/run_folder.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/metrics/trajectory_file.h"
#include "bench/report/table_files.h"
#include "slam/mapping/map_io.h"
#include "slam/types/config.h"

namespace groundloop::bench {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

json read_json(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw InputError(Problem{file, 0, "", "", "a readable file"});
  try {
    return json::parse(in);
  } catch (const json::exception& error) {
    throw InputError(Problem{file, 0, "", error.what(), "JSON"});
  }
}

/// Runs a reader of parsed JSON and turns a value of the wrong type into a problem of that file.
template <class Reader>
auto with_file(const std::string& file, const char* wanted, const Reader& reader) {
  try {
    return reader(read_json(file));
  } catch (const json::exception& error) {
    throw InputError(Problem{file, 0, "", error.what(), wanted});
  }
}

std::string text_of(const json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

std::map<std::string, std::string> texts_of(const json& object) {
  std::map<std::string, std::string> texts;
  for (const auto& [key, value] : object.items()) texts[key] = text_of(value);
  return texts;
}

std::optional<double> number_of(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

RunHeader header_of(const json& run) {
  RunHeader header;
  header.version = run.value("version", "");
  header.name = run.at("name").get<std::string>();
  header.summary = run.value("summary", "");
  header.seed = run.value("seed", uint64_t{0});
  header.kind = run.value("kind", header.kind);
  header.preset = run.value("preset", "");
  header.oracles = run.value("oracles", "");
  header.frames = run.value("frames", int64_t{0});
  if (run.contains("renderer") && run["renderer"].is_object()) header.renderer = texts_of(run["renderer"]);
  if (run.contains("isa")) header.isa = text_of(run["isa"]);
  if (run.contains("hashes")) header.hashes = texts_of(run["hashes"]);
  if (run.contains("argv")) header.argv = run["argv"].get<std::vector<std::string>>();
  const json& verdict = run.at("verdict");
  header.result = verdict.at("result").get<std::string>();
  for (const json& line : verdict.value("lines", json::array())) {
    header.judged.push_back({line.at("metric").get<std::string>(), number_of(line, "value"),
                             number_of(line, "min"), number_of(line, "max"), line.at("ok").get<bool>()});
  }
  return header;
}

std::map<std::string, double> metrics_of(const json& flat) {
  std::map<std::string, double> metrics;
  for (const auto& [name, value] : flat.items()) {
    if (!value.is_null()) metrics[name] = value.get<double>();
  }
  return metrics;
}

std::vector<OracleRow> oracles_of(const json& rows) {
  std::vector<OracleRow> oracles;
  for (const json& row : rows) {
    oracles.push_back({row.at("exact").get<std::string>(), row.at("outcome").get<std::string>(),
                       metrics_of(row.at("metrics"))});
  }
  return oracles;
}

slam::Pose alignment_of(const json& alignment) {
  const auto numbers = alignment.at("T_world_map").get<std::array<double, 16>>();
  slam::Pose T_world_map;
  T_world_map.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  return T_world_map;
}

std::vector<Footprint> outline_of(const json& things) {
  std::vector<Footprint> outline;
  for (const json& thing : things) {
    Footprint& footprint = outline.emplace_back();
    footprint.name = thing.value("name", "");
    for (const json& corner : thing.at("polygon")) {
      const auto xy = corner.get<std::array<double, 2>>();
      footprint.polygon.emplace_back(xy[0], xy[1]);
    }
  }
  return outline;
}

}  // namespace

RunFolder load_run_folder(const std::string& dir) {
  const fs::path root(dir);
  const auto path = [&](const char* name) { return (root / name).string(); };
  const auto has = [&](const char* name) { return fs::exists(root / name); };

  RunFolder run;
  run.dir = dir;
  run.header = with_file(path("run.json"), "name, verdict.result and verdict.lines of a run", header_of);
  const auto tum = [&](const char* name) {
    return read_trajectory(path(name), TrajectoryFormat::kTum).poses;
  };
  if (has("truth.tum")) run.truth = tum("truth.tum");
  if (has("estimate.tum")) run.estimate = tum("estimate.tum");
  if (has("without_links.tum")) run.without_links = tum("without_links.tum");
  if (has("links.csv")) run.links = read_links(path("links.csv"));
  if (has("oracles.json")) {
    run.oracles = with_file(path("oracles.json"), "a list of {exact, outcome, metrics}", oracles_of);
  }
  if (has("keyframes.csv")) run.key_frames = read_key_frames(path("keyframes.csv"));
  if (has("frames.csv")) run.frames = read_frame_table(path("frames.csv"));
  if (has("metrics.json"))
    run.metrics = with_file(path("metrics.json"), "a flat object of numbers", metrics_of);
  if (has("alignment.json")) {
    run.T_world_map = with_file(path("alignment.json"), "T_world_map: 16 numbers", alignment_of);
  }
  if (has("cloud.ply")) run.cloud = slam::read_ply(path("cloud.ply"));
  if (has("map.yaml")) run.map = slam::read_map(path("map.yaml"));
  if (has("truth_map.yaml")) run.truth_map = slam::read_map(path("truth_map.yaml"));
  if (has("visible.yaml")) run.visible = slam::read_map(path("visible.yaml"));
  if (has("outline.json")) {
    run.outline = with_file(path("outline.json"), "a list of {name, polygon: [[x, y], ...]}", outline_of);
  }
  if (run.visible && run.truth_map && run.visible->value.size() != run.truth_map->value.size()) {
    throw InputError(Problem{path("visible.yaml"), 0, "size", "", "the size of truth_map"});
  }
  return run;
}

}  // namespace groundloop::bench
