#include "slam/source/kitti_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "slam/source/image_file.h"
#include "slam/source/text.h"
#include "slam/types/config.h"

namespace groundloop::slam {
namespace {

using Projection = std::array<double, 12>;  ///< 3x4, row by row

constexpr const char* kWantedCalib =
    "KITTI calibration: lines \"P0: ...\" and \"P1: ...\" of 12 numbers each";
constexpr const char* kWantedTimes = "a text file, one time in seconds a line";

/// Lines "P0: 12 numbers" (the colon may be missing); other lines are not ours.
std::map<std::string, Projection> read_projections(const std::string& file, std::vector<Problem>& problems) {
  std::map<std::string, Projection> projections;
  for (const TextLine& line : read_lines(file, kWantedCalib)) {
    const auto words = split(line.text, " \t:,");
    const std::string name(words.front());
    if (name != "P0" && name != "P1") continue;
    if (words.size() != 13) {
      problems.push_back(
          {file, line.number, name, fmt::format("{} numbers", words.size() - 1), "12 numbers"});
      continue;
    }
    Projection& P = projections[name];
    for (size_t i = 0; i < P.size(); ++i) {
      const auto number = to_double(words[i + 1]);
      if (!number) problems.push_back({file, line.number, name, std::string(words[i + 1]), "a number"});
      P[i] = number.value_or(0);
    }
  }
  for (const char* name : {"P0", "P1"}) {
    if (projections.count(name) == 0) problems.push_back({file, 0, name, "missing", kWantedCalib});
  }
  return projections;
}

/// Rectified rig of P0 = K [I | 0] and P1 = K' [I | (-baseline, 0, 0)].
StereoRig rig_of(const Projection& P0, const Projection& P1, const std::string& file,
                 std::vector<Problem>& problems) {
  StereoRig rig;
  rig.fx_px = P0[0], rig.cx_px = P0[2];
  rig.fy_px = P0[5], rig.cy_px = P0[6];
  rig.cx_right_px = P1[2];
  if (!(rig.fx_px > 0)) problems.push_back({file, 0, "P0[0]", fmt::format("{}", rig.fx_px), "fx above 0"});
  if (!(rig.fy_px > 0)) problems.push_back({file, 0, "P0[5]", fmt::format("{}", rig.fy_px), "fy above 0"});
  const auto same = [&](size_t i, const char* what) {
    if (std::abs(P0[i] - P1[i]) > 1e-6 * std::max(1.0, std::abs(P0[i]))) {
      problems.push_back({file, 0, fmt::format("P1[{}]", i), fmt::format("{}", P1[i]),
                          fmt::format("{} as in P0, {}: a rectified pair", what, P0[i])});
    }
  };
  same(0, "fx"), same(5, "fy"), same(6, "cy");
  // The left camera is the origin, wherever P0 itself stands (KITTI's P2, P3 stand aside of it).
  rig.baseline_m = -(P1[3] - P0[3]) / P1[0];
  if (!(rig.baseline_m > 0)) {
    problems.push_back({file, 0, "P1[3]", fmt::format("{}", P1[3]), "-fx * baseline, less than P0[3]"});
  }
  return rig;
}

std::vector<int64_t> read_times(const std::string& file, std::vector<Problem>& problems) {
  std::vector<int64_t> stamps_ns;
  std::set<int64_t> known;
  for (const TextLine& line : read_lines(file, kWantedTimes)) {
    const auto words = split(line.text, " \t");
    const auto stamp_ns = seconds_to_ns(words.front());
    if (!stamp_ns || words.size() != 1) {
      problems.push_back({file, line.number, "", line.text, "a time in seconds"});
      continue;
    }
    if (!known.insert(*stamp_ns).second) {
      problems.push_back({file, line.number, "", line.text, "a time that no other pair has"});
    }
    stamps_ns.push_back(*stamp_ns);
  }
  return stamps_ns;
}

std::vector<std::string> list_images(const std::string& directory, std::vector<Problem>& problems) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (entry.path().extension() == ".png") files.push_back(entry.path().string());
  }
  if (error) problems.push_back({directory, 0, "", "no such folder", "a folder of PNG images"});
  std::sort(files.begin(), files.end());
  return files;
}

/// values[order[0]], values[order[1]], ...
template <class T>
std::vector<T> rearranged(const std::vector<T>& values, const std::vector<size_t>& order) {
  std::vector<T> result;
  for (const size_t i : order) result.push_back(values[i]);
  return result;
}

}  // namespace

KittiSource::KittiSource(const std::string& directory, const SourceOptions& options) {
  std::vector<Problem> problems;
  const auto collect = [&](auto read) {
    try {
      read();
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  };
  const bool raw = !options.calibration_files.empty();
  StereoCalibration calibration;
  collect([&] {
    if (raw) {
      calibration = read_stereo_calibration(options.calibration_files);
      return;
    }
    const std::string file = directory + "/calib.txt";
    const size_t before = problems.size();
    const auto projections = read_projections(file, problems);
    if (problems.size() == before) rig_ = rig_of(projections.at("P0"), projections.at("P1"), file, problems);
  });
  collect([&] { stamps_ns_ = read_times(directory + "/times.txt", problems); });
  left_files_ = list_images(directory + "/image_0", problems);
  right_files_ = list_images(directory + "/image_1", problems);
  if (!problems.empty()) throw InputError(std::move(problems));

  if (stamps_ns_.empty())
    throw InputError(Problem{directory + "/times.txt", 0, "", "no times", kWantedTimes});
  for (const auto& [folder, files] :
       {std::pair{"/image_0", &left_files_}, std::pair{"/image_1", &right_files_}}) {
    if (files->size() == stamps_ns_.size()) continue;
    problems.push_back({directory + folder, 0, "", fmt::format("{} PNG images", files->size()),
                        fmt::format("{}, one for every line of times.txt", stamps_ns_.size())});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  out_of_order_ = !std::is_sorted(stamps_ns_.begin(), stamps_ns_.end());
  if (out_of_order_) {
    std::vector<size_t> order(stamps_ns_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(),
              [this](size_t a, size_t b) { return stamps_ns_[a] < stamps_ns_[b]; });
    stamps_ns_ = rearranged(stamps_ns_, order);
    left_files_ = rearranged(left_files_, order);
    right_files_ = rearranged(right_files_, order);
  }
  const cv::Mat first = read_grey_image(left_files_.front());
  rig_.width_px = first.cols, rig_.height_px = first.rows;
  if (raw) rig_ = rectifier_.emplace(calibration, first.size()).rig();
  rig_.T_body_left = StereoRig::level_camera({0, 0, options.camera_height_m});
}

std::optional<StereoFrame> KittiSource::next() {
  if (next_ == size()) return std::nullopt;
  StereoFrame frame;
  frame.index = next_;
  frame.stamp_ns = stamps_ns_[next_];
  frame.left = read_grey_image(left_files_[next_], rig_.width_px, rig_.height_px);
  frame.right = read_grey_image(right_files_[next_], rig_.width_px, rig_.height_px);
  if (rectifier_) {
    const cv::Mat raw_left = std::exchange(frame.left, {}), raw_right = std::exchange(frame.right, {});
    rectifier_->rectify(raw_left, raw_right, frame);
  }
  ++next_;
  return frame;
}

}  // namespace groundloop::slam
