#include "bench/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <ostream>

#include "bench/report/figures.h"
#include "bench/report/html.h"
#include "bench/report/plate.h"
#include "bench/report/report_style.h"
#include "bench/report/report_tables.h"
#include "bench/report/run_folder.h"
#include "bench/report/run_series.h"
#include "bench/report/svg_plot.h"
#include "slam/mapping/atomic_file.h"
#include "slam/types/config.h"
#include "slam/types/frame_result.h"

namespace groundloop::bench {
namespace {

namespace fs = std::filesystem;

// Sizes of the encoded pictures; base64 adds a third, plots and tables stay below 1 MB: the report below 5
// MB.
constexpr size_t kPhotoBytes = 600'000;
constexpr size_t kTopViewBytes = 1'000'000;
constexpr size_t kPlateBytes = 700'000;
constexpr size_t kPlanBytes = 300'000;

std::string note(const std::string& text) { return "<p class=\"note\">" + text + "</p>"; }

std::string figure(const std::string& content, const std::string& title, const std::string& caption) {
  return "<figure>" + content + "<figcaption><b>" + title + "</b> " + caption + "</figcaption></figure>";
}

std::string section(const std::string& title, const std::string& content) {
  return "<section><h2>" + title + "</h2>" + content + "</section>\n";
}

std::string image(const Picture& picture, Content content, size_t max_bytes, const std::string& alt) {
  return fmt::format("<img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\">",
                     image_uri(picture, content, max_bytes), picture.bgr.cols, picture.bgr.rows,
                     escape_html(alt));
}

std::string plot(const Plot& what) { return "<div class=\"scroll\">" + svg_plot(what) + "</div>"; }

/// A picture that the run left in figures/; empty when it did not.
Picture left_by_run(const RunFolder& run, const char* name) {
  std::ifstream file(fs::path(run.dir) / "figures" / name, std::ios::binary);
  Picture picture;
  picture.png.assign(std::istreambuf_iterator<char>(file), {});
  if (!picture.png.empty()) picture.bgr = cv::imdecode(picture.png, cv::IMREAD_COLOR);
  return picture;
}

Picture saved(const RunFolder& run, const char* name, const cv::Mat& bgr) {
  Picture picture = packed(bgr);
  slam::write_file_atomically((fs::path(run.dir) / "figures" / name).string(), [&](std::ostream& out) {
    out.write(reinterpret_cast<const char*>(picture.png.data()),
              static_cast<std::streamsize>(picture.png.size()));
  });
  return picture;
}

// ---- first screen

std::string verdict(const RunHeader& header) {
  size_t held = 0;
  std::string reasons;
  for (const JudgedMetric& judged : header.judged) {
    held += judged.ok ? 1 : 0;
    if (!judged.ok) reasons += "<li>" + escape_html(judged_sentence(judged)) + "</li>";
  }
  if (!reasons.empty()) reasons = "<ul>" + reasons + "</ul>";
  const size_t all = header.judged.size();
  const std::string count = all == 0 ? "nothing was expected of this run."
                            : held == all
                                ? fmt::format("{} of {} expectations hold.", held, all)
                                : fmt::format("{} of {} expectations do not hold.", all - held, all);
  if (header.result == "pass") {
    return "<div class=\"verdict pass\"><strong>✓ Pass:</strong> " + count + reasons + "</div>";
  }
  if (header.result == "fell short") {
    return "<div class=\"verdict short\"><strong>✗ Fell short:</strong> " + count + reasons + "</div>";
  }
  return "<div class=\"verdict error\"><strong>! Error:</strong> the run could not be judged." + reasons +
         "</div>";
}

/// A run with an oracle is not a result of the SLAM, and says so before anything else.
std::string experiment(const RunHeader& header) {
  if (header.oracles.empty()) return "";
  return "<div class=\"verdict error\"><strong>Experiment:</strong> exact answers in the place of " +
         escape_html(header.oracles) + "; not a result of the SLAM.</div>";
}

std::string tiles(const RunFolder& run) {
  constexpr std::array<std::array<const char*, 2>, 8> kTiles = {
      {{"trajectory.ate_rmse_m", "position error (ATE)"},
       {"trajectory.rpe_trans_percent", "drift"},
       {"trajectory.end_yaw_deg", "heading error at end"},
       {"trajectory.length_m", "path"},
       {"trajectory.lost_frames", "lost frames"},
       {"map.f1", "map F1"},
       {"timing.slam_ms_median", "SLAM a pair, median"},
       {"timing.realtime_factor", "speed over real time"}}};
  std::string html = "<dl class=\"tiles\">";
  html += fmt::format("<div><dt>stereo pairs</dt><dd>{}</dd></div>", run.header.frames);
  for (const auto& [metric, title] : kTiles) {
    const auto found = run.metrics.find(metric);
    if (found == run.metrics.end()) continue;
    html +=
        fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", title, value_with_unit(metric, found->second, 3));
  }
  return html + "</dl>";
}

// ---- figures after the paper's

std::string frame_section(const RunFolder& run) {
  std::string html = "<div class=\"pair\">";
  if (const Picture tracked = left_by_run(run, "left_tracked.png"); !tracked.bgr.empty()) {
    html +=
        figure(image(tracked, Content::kPhoto, kPhotoBytes,
                     "Left image of the stereo pair with tracked features marked"),
               "Left image with tracked features.",
               "Rings: tracked and agreeing with the motion; crosses: tracked but rejected; squares: new. "
               "(Paper: Fig. 1 simulated, Fig. 7 real.)");
  }
  if (const Picture disparity = left_by_run(run, "disparity.png"); !disparity.bgr.empty()) {
    html += figure(image(disparity, Content::kPhoto, kPhotoBytes * 2 / 3,
                         "Dense disparity map in false colours with its scale"),
                   "Dense disparity.", "Red is near, blue far, dark unknown. (Paper: Fig. 2.)");
  }
  html += "</div>";
  return html == "<div class=\"pair\"></div>" ? note("The run kept no left image and no disparity map.")
                                              : html;
}

/// Empty when there is nothing to show.
cv::Mat top_view_of(const TopView& view) {
  return view.estimate.empty() && view.cloud.empty() ? cv::Mat() : draw_top_view(view);
}

std::string top_view_section(const RunFolder& run, const TopView& view, const cv::Mat& drawn) {
  if (drawn.empty()) return note("The run left no trajectory and no point cloud.");
  const Picture picture = saved(run, "top_view.png", drawn);
  const std::string truth = view.truth.empty() ? "No true trajectory is known."
                                               : "Black: the true trajectory, red: the estimated one.";
  std::string links;
  if (!view.links.empty()) links += " Violet: from where a place was seen first to where it was recognised.";
  if (!view.without_links.empty()) links += " Orange: the estimate, had no place been recognised.";
  return figure(
      image(picture, Content::kDrawn, kTopViewBytes, "Top view of trajectory and point cloud over the scene"),
      "Top view of trajectory and point cloud.",
      truth + links +
          " Dots and segments: position and heading of key frames. Points are coloured by height; "
          "uncertain ones are faint. (Paper: Fig. 3 simulated, Fig. 8 real.)");
}

/// The run's map as it is shown.
struct MapPictures {
  cv::Mat pair;        ///< beside the exact one, when that is known; empty without a map
  cv::Mat difference;  ///< from the exact one; empty when that is not known, or not what was visible of it
  bool exact_known = false;
};

MapPictures map_pictures(const RunFolder& run, const PlacedRun& place) {
  if (!run.map) return {};
  const bool exact_known = run.truth_map && run.header.kind == "run" && run.T_world_map;
  const std::vector<uint8_t> visible = [&] {
    std::vector<uint8_t> cells;
    if (run.visible) {
      for (const float value : run.visible->value) cells.push_back(value > 0.5F ? 1 : 0);
    }
    return cells;
  }();
  slam::OccupancyMap shown = *run.map;
  if (exact_known) {
    slam::GridGeometry around =
        run.truth_map->geometry;  // half a metre more, for what is mapped beyond the walls
    const int margin = static_cast<int>(0.5 / around.cell_m);
    around.x_min_m -= margin * around.cell_m;
    around.y_min_m -= margin * around.cell_m;
    around.cols += 2 * margin;
    around.rows += 2 * margin;
    shown = resampled_map(*run.map, place.T_frame_map, around);
  }
  MapPictures pictures;
  pictures.exact_known = exact_known;
  pictures.pair = draw_map_pair(shown, exact_known ? run.truth_map : std::nullopt, visible);
  if (!exact_known || visible.empty()) return pictures;
  pictures.difference = draw_map_difference(
      resampled_map(*run.map, place.T_frame_map, run.truth_map->geometry), *run.truth_map, visible);
  return pictures;
}

std::string map_section(const RunFolder& run, const MapPictures& pictures) {
  if (pictures.pair.empty()) return note("The run left no occupancy map.");
  const Picture pair = saved(run, "map.png", pictures.pair);
  const std::string caption = pictures.exact_known
                                  ? "Left: what SLAM made; right: exact, from the geometry of the scene."
                                  : "No exact map is known for this run.";
  std::string html =
      figure(image(pair, Content::kDrawn, kPlanBytes, "Estimated occupancy map and the exact one"),
             "Final occupancy map.", caption + " (Paper: Fig. 4 simulated, Fig. 9 real.)");
  if (pictures.difference.empty()) return html;
  const Picture difference = saved(run, "map_difference.png", pictures.difference);
  return html + figure(image(difference, Content::kDrawn, kPlanBytes,
                             "Differences of the estimated from the exact map"),
                       "Where the map is wrong.", "Cell by cell, where the true trajectory could see.");
}

std::string scene_section(const RunFolder& run) {
  const Picture preview = left_by_run(run, "preview.png");
  if (preview.bgr.empty()) return note("The run left no picture of the scene and plan.");
  return figure(
      image(preview, Content::kDrawn, kPlanBytes, "Top view of the scene with the planned trajectory"),
      "Model of the scene and planned trajectory.", "(Paper: Fig. 5.)");
}

/// The five figures of the paper's simulated run; nothing when one is missing.
std::string plate_section(const RunFolder& run, const cv::Mat& top_view, const cv::Mat& map) {
  const cv::Mat left = left_by_run(run, "left.png").bgr, disparity = left_by_run(run, "disparity.png").bgr;
  const cv::Mat scene = left_by_run(run, "preview.png").bgr;
  for (const cv::Mat& picture : {left, disparity, top_view, scene, map}) {
    if (picture.empty()) return "";
  }
  const cv::Mat plate = draw_plate({{{"Fig. 1: left image", left}, {"Fig. 2: dense disparity", disparity}},
                                    {{"Fig. 3: estimated trajectory and cloud", top_view},
                                     {"Fig. 5: model of the scene, planned trajectory", scene}},
                                    {{"Fig. 4: final occupancy map", map}}});
  const Picture picture = saved(run, "paper_figures.png", plate);
  return section(
      "The paper's five figures",
      figure(image(picture, Content::kPhoto, kPlateBytes,
                   "Left image, disparity, top view, scene with plan, and map on one plate"),
             "Side by side.", "Numbered as in the paper, section 3.1; each again below, in full size."));
}

// ---- plots over time

std::string error_plots(const RunFolder& run, const TopView& view) {
  const ErrorSeries errors = error_series(view, first_stamp_ns(run));
  if (errors.t_s.empty()) return note("Without a true trajectory there are no errors over time.");
  const auto lost = lost_spans_s(run.frames);
  const auto over_time = [&](const char* what, const char* unit, const std::vector<double>& y,
                             const char* colour, double min_span) {
    return plot({.description = std::string(what) + " over time",
                 .x_label = "time [s]",
                 .y_label = std::string(what) + " [" + unit + "]",
                 .x = errors.t_s,
                 .series = {{what, colour, y}},
                 .bands = lost,
                 .band_name = "lost",
                 .min_y_span = min_span});
  };
  return figure(over_time("position error", "m", errors.position_m, "var(--s1)", 0.01) +
                    over_time("heading error", "°", errors.yaw_deg, "var(--s3)", 0.2),
                "Errors over time.",
                "After alignment of the whole trajectory; heading as estimated minus true.");
}

std::string count_plot(const RunFolder& run) {
  Plot counts{.description = "Tracked features and inliers over time",
              .x_label = "time [s]",
              .y_label = "features",
              .x = frame_times_s(run.frames),
              .series = {},
              .bands = lost_spans_s(run.frames),
              .band_name = "lost"};
  const auto add = [&](const char* column, const char* name, const char* colour, bool area) {
    const auto& values = run.frames.column(column);
    if (!values.empty()) counts.series.push_back({name, colour, values, area});
  };
  add("features_tracked", "tracked", "var(--pale)", true);  // an area, for the inliers nearly cover it
  add("inliers", "inliers", "var(--s1)", false);
  if (counts.series.empty() || counts.x.empty()) return note("The run left no counts of features.");
  return figure(plot(counts), "Features.", "Tracked into each frame, and those that agreed with the motion.");
}

/// Means of each `stretch` values, the last of what remains.
std::vector<double> means(const std::vector<double>& values, size_t stretch) {
  std::vector<double> result;
  for (size_t begin = 0; begin < values.size(); begin += stretch) {
    const size_t end = std::min(begin + stretch, values.size());
    double sum = 0;
    for (size_t i = begin; i < end; ++i) sum += values[i];
    result.push_back(sum / static_cast<double>(end - begin));
  }
  return result;
}

std::string time_plot(const RunFolder& run) {
  // every key frame is a peak: many of them would only be a blur
  const size_t stretch = 1 + run.frames.rows / 200;
  Plot times{.description = "Time of each stage over the run, stacked",
             .x_label = "time [s]",
             .y_label = "SLAM time [ms]",
             .x = means(frame_times_s(run.frames), stretch),
             .series = {},
             .bands = {},
             .band_name = ""};
  for (size_t stage = 0; stage < slam::kStageCount; ++stage) {
    const std::string name = slam::name_of(static_cast<slam::Stage>(stage));
    const auto& values = run.frames.column(name + "_ms");
    if (!values.empty()) times.series.push_back({name, stage_colour(stage), means(values, stretch), true});
  }
  if (times.series.empty() || times.x.empty()) return note("The run left no stage times.");
  return figure(plot(times), "Time of the stages.",
                stretch == 1
                    ? "Stacked; peaks are key frames."
                    : fmt::format("Stacked, mean of each {} pairs; the table below has the peaks.", stretch));
}

std::string memory_plot(const RunFolder& run) {
  const auto& memory = run.frames.column("memory_mb");
  if (memory.empty()) return "";
  return figure(plot({.description = "Resident memory over time",
                      .x_label = "time [s]",
                      .y_label = "memory [MB]",
                      .x = frame_times_s(run.frames),
                      .series = {{"resident", "var(--s1)", memory}},
                      .bands = {},
                      .band_name = ""}),
                "Memory.", "Of the whole process, simulator and renderer included.");
}

/// All sections with pictures. Most of a report's time goes into drawing and packing them, so they are made
/// side by side.
std::string picture_sections(const RunFolder& run, const PlacedRun& place) {
  const auto beside = [](auto make) { return std::async(std::launch::async, make); };
  std::future<cv::Mat> drawn = beside([&] { return top_view_of(place.view); });
  const MapPictures maps = map_pictures(run, place);
  const cv::Mat top_view = drawn.get();
  std::future<std::string> plate = beside([&] { return plate_section(run, top_view, maps.pair); }),
                           frame = beside([&] { return frame_section(run); }),
                           seen = beside([&] { return top_view_section(run, place.view, top_view); }),
                           map = beside([&] { return map_section(run, maps); });
  const std::string scene =
      run.header.kind == "run" ? section("Scene and plan", scene_section(run)) : std::string();
  return plate.get() + section("What the cameras saw", frame.get()) +
         section("Trajectory and cloud", seen.get()) + section("Occupancy map", map.get()) + scene;
}

std::string page(const RunFolder& run) {
  const RunHeader& header = run.header;
  const PlacedRun place = placed(run);
  const std::string name = escape_html(header.name);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
      "<title>" +
      name + " – groundloop</title><style>" + kReportStyle + "</style></head>\n<body><header>";
  const std::string kind = header.kind == "replay" ? "replay of a recorded sequence" : "simulated run";
  html += "<p class=\"kicker\">groundloop " + escape_html(header.version) + " · " + kind + "</p><h1>" + name +
          "</h1>";
  html += "<p class=\"summary\">" + escape_html(header.summary) + "</p>";
  html += experiment(header) + verdict(header) + tiles(run) + "</header>\n<main>";
  html += picture_sections(run, place);
  html += section("Over time",
                  error_plots(run, place.view) + count_plot(run) + time_plot(run) + memory_plot(run));
  html +=
      section("Numbers", expectation_table(header) + oracle_table(run.oracles) + "<div class=\"tables\">" +
                             metric_tables(run.metrics) + "</div>" + stage_table(run.frames));
  html += section("Where it comes from", provenance_table(header)) + "</main>\n";
  html +=
      "<footer>Made by groundloop from the run folder alone. Figures correspond to those of the paper that "
      "preset <code>paper</code> follows.</footer></body></html>\n";
  return html;
}

}  // namespace

std::string write_report(const std::string& run_dir) {
  const RunFolder run = load_run_folder(run_dir);
  std::error_code error;
  fs::create_directories(fs::path(run_dir) / "figures", error);
  if (error) {
    throw InputError(Problem{run_dir, 0, "figures", error.message(), "a folder that can be written to"});
  }
  std::string file = (fs::path(run_dir) / "report.html").string();
  const std::string html = page(run);
  slam::write_file_atomically(file, [&](std::ostream& out) { out << html; });
  return file;
}

}  // namespace groundloop::bench
