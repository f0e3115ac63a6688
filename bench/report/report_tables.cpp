#include "bench/report/report_tables.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "bench/report/html.h"
#include "bench/report/run_series.h"
#include "slam/types/frame_result.h"

namespace groundloop::bench {
namespace {

struct Unit {
  const char* token;  ///< part of a metric's name
  const char* text;
};
/// Longer tokens first: the first that the name holds counts.
constexpr std::array<Unit, 11> kUnits = {{{"_deg_per_m", "°/m"},
                                          {"_percent", "%"},
                                          {"_m2", "m²"},
                                          {"_ms", "ms"},
                                          {"_mb", "MB"},
                                          {"_deg", "°"},
                                          {"_px", "px"},
                                          {"_rad", "rad"},
                                          {"_factor", "×"},
                                          {"_m", "m"},
                                          {"_s", "s"}}};

/// The unit named at the end of the name, or before its statistic (slam_ms_median).
std::string unit_of(const std::string& metric) {
  for (const Unit& unit : kUnits) {
    const std::string token = unit.token;
    if (metric.ends_with(token) || metric.find(token + "_") != std::string::npos) return unit.text;
  }
  return "";
}

std::string number_text(double value, int digits) {
  if (!std::isfinite(value)) return "not finite";
  if (value == std::floor(value) && std::abs(value) < 1e9) return fmt::format("{:.0f}", value);
  return std::abs(value) >= 1000 ? fmt::format("{:.0f}", value) : fmt::format("{:.{}g}", value, digits);
}

std::string bound_text(const JudgedMetric& judged) {
  if (judged.min && judged.max) {
    return value_with_unit(judged.metric, *judged.min) + " to " + value_with_unit(judged.metric, *judged.max);
  }
  if (judged.min) return "at least " + value_with_unit(judged.metric, *judged.min);
  if (judged.max) return "at most " + value_with_unit(judged.metric, *judged.max);
  return "no bound";
}

const std::map<std::string, std::string>& meanings() {
  static const std::map<std::string, std::string> kMeanings = {
      {"trajectory.ate_rmse_m", "position error, root mean square, after rigid alignment"},
      {"trajectory.ate_max_m", "largest position error after rigid alignment"},
      {"trajectory.rpe_trans_percent", "drift in position over pieces of 1 to 8 m"},
      {"trajectory.rpe_rot_deg_per_m", "drift in heading over pieces of 1 to 8 m"},
      {"trajectory.drift_5m_percent", "drift in position over pieces of 5 m"},
      {"trajectory.end_error_m", "distance from the true end, started from the true start"},
      {"trajectory.end_yaw_deg", "heading error at the end, started from the true start"},
      {"trajectory.length_m", "length of the true path"},
      {"trajectory.lost_frames", "frames without a pose from vision"},
      {"trajectory.completeness", "part of the frames with a pose from vision"},
      {"tracking.interruptions", "losses of track, and being carried away"},
      {"tracking.relocalised_s", "longest time until the pose was right again"},
      {"tracking.silent_jumps", "steps that the camera did not make, unannounced"},
      {"tracking.row_offset_px", "slip of the right image's rows, found and taken back"},
      {"tracking.right_late_s", "longest delay of the right image, found and taken off"},
      {"map.f1", "harmonic mean of precision and recall of occupied cells"},
      {"map.iou", "intersection over union of occupied cells"},
      {"map.mcc", "Matthews correlation of occupied and free"},
      {"map.precision", "part of the cells called occupied that are"},
      {"map.recall", "part of the occupied cells that were found"},
      {"map.false_free_m2", "occupied area called free"},
      {"map.wall_offset_mean_m", "mean distance of mapped from true walls"},
      {"map.wall_offset_p95_m", "95 % of mapped walls are nearer to true ones"},
      {"map.brier", "mean squared error of the cells' probabilities"},
      {"map.with_true_poses.f1", "the same mapping on true poses: the ceiling"},
      {"stage.disparity_rmse_px", "dense disparity against exact depth"},
      {"stage.stereo_outlier_fraction", "left-right matches farther off than their bound"},
      {"stage.track_rmse_px", "feature tracks against exact motion"},
      {"stage.track_outlier_fraction", "feature tracks farther off than their bound"},
      {"stage.point_rmse_m", "triangulated points against the scene"},
      {"stage.registration_trans_m", "registered motion against the true one"},
      {"stage.registration_rot_deg", "registered rotation against the true one"},
      {"uncertainty.nees_mean", "squared error by covariance of key-frame motions; honest: 6"},
      {"uncertainty.nees_samples", "key-frame motions that it is the mean of"},
      {"loop.precision", "part of the closed loops that are real"},
      {"loop.recall", "part of the real loops that were closed"},
      {"loop.ate_before_m", "position error before loops are closed"},
      {"loop.ate_after_m", "position error after loops are closed"},
      {"timing.render_ms", "rendering of a pair"},
      {"timing.slam_ms_median", "SLAM a pair, median"},
      {"timing.slam_ms_p99", "SLAM a pair, 99 % are faster"},
      {"timing.keyframe_ms_median", "SLAM on key frames, median"},
      {"timing.wall_s", "wall time of the run"},
      {"timing.realtime_factor", "simulated time by wall time"},
      {"peak_memory_mb", "largest resident memory"}};
  return kMeanings;
}

std::string meaning_of(const std::string& metric) {
  const auto found = meanings().find(metric);
  return found == meanings().end() ? "" : found->second;
}

std::string metric_table(const std::string& title, const std::map<std::string, double>& metrics) {
  std::string html =
      "<div class=\"card\"><table><caption>" + title +
      "</caption><thead><tr><th scope=\"col\">metric</th><th scope=\"col\" class=\"n\">value</th>"
      "</tr></thead><tbody>";
  for (const auto& [name, value] : metrics) {
    html += "<tr><td><code>" + escape_html(name) + "</code>";
    if (const std::string meaning = meaning_of(name); !meaning.empty())
      html += "<small>" + meaning + "</small>";
    html += "</td><td class=\"n\">" + value_with_unit(name, value) + "</td></tr>";
  }
  return html + "</tbody></table></div>";
}

std::string key_value_row(const std::string& key, const std::string& value) {
  if (value.empty()) return "";
  return "<tr><th scope=\"row\">" + escape_html(key) + "</th><td><code>" + escape_html(value) +
         "</code></td></tr>";
}

/// By how much a value differs from the first run's, in small print; empty for the first run itself.
std::string change_text(const OracleRow& first, const OracleRow& row, const std::string& name) {
  const auto base = first.metrics.find(name), value = row.metrics.find(name);
  if (&row == &first || base == first.metrics.end() || value == row.metrics.end() || base->second == 0)
    return "";
  return fmt::format("<small>{:+.0f} %</small>", 100 * (value->second / base->second - 1));
}

}  // namespace

std::string value_with_unit(const std::string& metric, double value, int digits) {
  const std::string unit = unit_of(metric);
  if (unit.empty()) return number_text(value, digits);
  return number_text(value, digits) + (unit == "°" ? "" : "\u00a0") + unit;
}

std::string judged_sentence(const JudgedMetric& judged) {
  const std::string value =
      judged.value ? "is " + value_with_unit(judged.metric, *judged.value) : "was not measured";
  return judged.metric + " " + value + ", wanted " + bound_text(judged);
}

std::string expectation_table(const RunHeader& header) {
  if (header.judged.empty()) return "<p class=\"note\">The scenario states no expectations.</p>";
  std::string html =
      "<div class=\"card wide\"><table><caption>Expectations</caption><thead><tr><th "
      "scope=\"col\">metric</th>"
      "<th scope=\"col\" class=\"n\">value</th><th scope=\"col\" class=\"n\">wanted</th>"
      "<th scope=\"col\">holds</th></tr></thead><tbody>";
  for (const JudgedMetric& judged : header.judged) {
    html += "<tr><td><code>" + escape_html(judged.metric) + "</code></td><td class=\"n\">" +
            (judged.value ? value_with_unit(judged.metric, *judged.value) : "not measured") +
            "</td><td class=\"n\">" + bound_text(judged) + "</td><td>" +
            (judged.ok ? "<span class=\"yes\">✓ yes</span>" : "<span class=\"no\">✗ no</span>") +
            "</td></tr>";
  }
  return html + "</tbody></table></div>";
}

std::string oracle_table(const std::vector<OracleRow>& rows) {
  if (rows.empty()) return "";
  std::set<std::string> names;
  for (const OracleRow& row : rows) {
    for (const auto& [name, value] : row.metrics) names.insert(name);
  }
  std::string html =
      "<div class=\"card wide\"><table><caption>Each stage's part of the error: the same run with exact "
      "answers in its place</caption><thead><tr><th scope=\"col\">exact</th>";
  for (const std::string& name : names) {
    html += "<th scope=\"col\" class=\"n\"><code>" + escape_html(name) + "</code></th>";
  }
  html += "<th scope=\"col\">verdict</th></tr></thead><tbody>";
  for (const OracleRow& row : rows) {
    html += "<tr><th scope=\"row\">" + (row.exact.empty() ? "nothing" : escape_html(row.exact)) + "</th>";
    for (const std::string& name : names) {
      const auto found = row.metrics.find(name);
      html += "<td class=\"n\">" + (found == row.metrics.end() ? "–" : value_with_unit(name, found->second)) +
              change_text(rows.front(), row, name) + "</td>";
    }
    html += "<td>" + escape_html(row.outcome) + "</td></tr>";
  }
  return html + "</tbody></table></div>";
}

std::string metric_tables(const std::map<std::string, double>& metrics) {
  const std::vector<std::pair<std::string, std::string>> groups = {
      {"trajectory", "Trajectory"},          {"tracking", "Interruptions"},  {"map", "Map"},
      {"stage", "Stages against the truth"}, {"uncertainty", "Uncertainty"}, {"loop", "Loop closing"},
      {"drive", "The drive itself"},         {"timing", "Timing"},           {"", "Others"}};
  std::map<std::string, std::map<std::string, double>> by_group;
  for (const auto& [name, value] : metrics) {
    std::string group = name.substr(0, name.find('.'));
    const bool known =
        std::any_of(groups.begin(), groups.end(), [&](const auto& g) { return g.first == group; });
    by_group[known ? group : ""][name] = value;
  }
  std::string html;
  for (const auto& [key, title] : groups) {
    if (by_group.contains(key)) html += metric_table(title, by_group[key]);
  }
  return html.empty() ? "<p class=\"note\">The run folder holds no metrics.</p>" : html;
}

std::string stage_colour(size_t stage) { return fmt::format("var(--s{})", stage + 1); }

std::string stage_table(const FrameTable& frames) {
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += std::isfinite(v) ? v : 0;
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
  };
  const double whole_ms = mean(frames.column("total_ms"));
  std::string rows;
  const auto row = [&](const std::string& name, const std::string& swatch, bool with_share) {
    const auto& times = frames.column(name + "_ms");
    if (times.empty()) return;
    rows += "<tr><th scope=\"row\">" + swatch + name + "</th>";
    for (const double fraction : {0.5, 0.95, 0.99, 1.0}) {
      const double time_ms = percentile(times, fraction);
      rows += "<td class=\"n\">" + (std::isfinite(time_ms) ? fmt::format("{:.2f}", time_ms) : "–") + "</td>";
    }
    const bool has_share = with_share && whole_ms > 0;
    rows += "<td class=\"n\">" + (has_share ? fmt::format("{:.0f} %", 100 * mean(times) / whole_ms) : "") +
            "</td></tr>";
  };
  for (size_t stage = 0; stage < slam::kStageCount; ++stage) {
    row(slam::name_of(static_cast<slam::Stage>(stage)),
        "<i class=\"swatch\" style=\"background:" + stage_colour(stage) + "\"></i>", true);
  }
  row("total", "", true);
  row("render", "", false);
  if (rows.empty()) return "";
  return "<div class=\"card wide\"><table><caption>Time of each stage a pair [ms]</caption><thead><tr>"
         "<th scope=\"col\">stage</th><th scope=\"col\" class=\"n\">median</th><th scope=\"col\" "
         "class=\"n\">p95</th>"
         "<th scope=\"col\" class=\"n\">p99</th><th scope=\"col\" class=\"n\">max</th>"
         "<th scope=\"col\" class=\"n\">share</th></tr></thead><tbody>" +
         rows + "</tbody></table></div>";
}

std::string provenance_table(const RunHeader& header) {
  std::string command;
  for (const std::string& word : header.argv) command += (command.empty() ? "" : " ") + word;
  std::string html =
      "<div class=\"card wide\"><table class=\"provenance\"><caption>Provenance</caption><tbody>";
  html += key_value_row("groundloop", header.version);
  html += key_value_row("kind", header.kind);
  html += key_value_row("command", command);
  html += key_value_row("preset", header.preset);
  html += key_value_row("exact stages", header.oracles);
  html += key_value_row("seed", std::to_string(header.seed));
  html += key_value_row("pairs", std::to_string(header.frames));
  html += key_value_row("instruction set", header.isa);
  for (const auto& [key, value] : header.renderer) html += key_value_row("renderer: " + key, value);
  for (const auto& [input, hash] : header.hashes) html += key_value_row("hash of " + input, hash);
  return html + "</tbody></table></div>";
}

}  // namespace groundloop::bench
