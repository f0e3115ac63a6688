#include "bench/metrics/trajectory_file.h"

#include <fmt/format.h>
#include <algorithm>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

namespace groundloop::bench {
namespace {

constexpr size_t kProblemsShown = 20;
constexpr double kRotationTolerance = 0.05;  // files carry 3 to 9 decimals; a wrong column is off by far more

std::vector<std::string_view> columns_of(std::string_view line, bool commas) {
  const char* separators = commas ? "," : " \t";
  std::vector<std::string_view> columns;
  size_t begin = 0;
  while (begin <= line.size()) {
    const size_t end = std::min(line.find_first_of(separators, begin), line.size());
    std::string_view column = line.substr(begin, end - begin);
    while (!column.empty() && column.front() == ' ') column.remove_prefix(1);
    while (!column.empty() && column.back() == ' ') column.remove_suffix(1);
    if (commas || !column.empty()) columns.push_back(column);
    begin = end + 1;
  }
  return columns;
}

template <class Number>
std::optional<Number> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return value;
}

const char* wanted_columns(TrajectoryFormat format) {
  switch (format) {
    case TrajectoryFormat::kTum:
      return "8 columns: seconds x y z qx qy qz qw";
    case TrajectoryFormat::kKitti:
      return "12 columns: a 3x4 matrix row by row";
    case TrajectoryFormat::kEuroc:
      return "at least 8 columns: nanoseconds, x, y, z, qw, qx, qy, qz";
  }
  return "";
}

bool is_comment_or_blank(std::string_view line) {
  const size_t first = line.find_first_not_of(" \t");
  return first == std::string_view::npos || line[first] == '#';
}

std::string shortened(std::string_view text) {
  return text.size() > 60 ? std::string(text.substr(0, 57)) + "..." : std::string(text);
}

/// Reads pose after pose and keeps the list of what is wrong.
class Reader {
 public:
  explicit Reader(const std::string& file, StampOrder order = StampOrder::kRising)
      : file_(file), order_(order), in_(file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
      throw InputError(Problem{file, 0, "", "no such file", "a trajectory file"});
    }
    if (!in_) throw InputError(Problem{file, 0, "", "cannot be opened", "a trajectory file"});
  }

  TrajectoryFile read(std::optional<TrajectoryFormat> format) {
    TrajectoryFile result;
    result.file = file_;
    std::string line;
    while (next_line(line)) {
      if (!format) format = format_of(line);
      result.format = *format;
      if (const auto pose = parse(line, *format)) append(*pose, line, result.poses);
      if (problems_.size() >= kProblemsShown) break;
    }
    if (result.poses.empty() && problems_.empty()) {
      throw InputError(Problem{file_, 0, "", "no pose", "at least one line with a pose"});
    }
    if (!problems_.empty()) throw InputError(problems_);
    std::stable_sort(result.poses.begin(), result.poses.end(),
                     [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; });
    return result;
  }

 private:
  bool next_line(std::string& line) {
    while (std::getline(in_, line)) {
      ++line_;
      if (line.ends_with('\r')) line.pop_back();
      if (!is_comment_or_blank(line)) return true;
    }
    return false;
  }

  void problem(std::string_view value, std::string wanted) {
    problems_.push_back({file_, line_, "", shortened(value), std::move(wanted)});
  }

  TrajectoryFormat format_of(const std::string& line) {
    if (line.find(',') != std::string::npos) return TrajectoryFormat::kEuroc;
    switch (columns_of(line, false).size()) {
      case 8:
        return TrajectoryFormat::kTum;
      case 12:
        return TrajectoryFormat::kKitti;
    }
    throw InputError(Problem{file_, line_, "", shortened(line),
                             "8 columns (TUM), 12 columns (KITTI) or columns with commas (EuRoC)"});
  }

  std::optional<slam::StampedPose> parse(const std::string& line, TrajectoryFormat format) {
    const bool commas = format == TrajectoryFormat::kEuroc;
    const auto columns = columns_of(line, commas);
    const size_t wanted = format == TrajectoryFormat::kKitti ? 12 : 8;
    if (columns.size() < wanted || (columns.size() > wanted && !commas)) {
      problem(fmt::format("{} columns", columns.size()), wanted_columns(format));
      return std::nullopt;
    }
    return format == TrajectoryFormat::kKitti ? parse_matrix(columns) : parse_quaternion(columns, format);
  }

  std::optional<double> number(std::string_view column) {
    const auto value = number_of<double>(column);
    if (!value) problem(column, "a finite number");
    return value;
  }

  std::optional<slam::StampedPose> parse_matrix(const std::vector<std::string_view>& columns) {
    slam::StampedPose pose;
    for (int i = 0; i < 12; ++i) {
      const auto value = number(columns[i]);
      if (!value) return std::nullopt;
      pose.T.matrix()(i / 4, i % 4) = *value;
    }
    pose.stamp_ns = poses_read_++ * 1'000'000'000;
    const Eigen::Matrix3d& R = pose.T.linear();
    const double deviation = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (deviation > kRotationTolerance || R.determinant() < 0) {
      problem(fmt::format("|R'R - I| = {:.3g}, det R = {:.3g}", deviation, R.determinant()),
              "a rotation matrix");
      return std::nullopt;
    }
    return pose;
  }

  std::optional<slam::StampedPose> parse_quaternion(const std::vector<std::string_view>& columns,
                                                    TrajectoryFormat format) {
    slam::StampedPose pose;
    const auto stamp_ns =
        format == TrajectoryFormat::kTum ? stamp_of_seconds(columns[0]) : stamp_of_nanoseconds(columns[0]);
    if (!stamp_ns) return std::nullopt;
    pose.stamp_ns = *stamp_ns;
    double values[7];
    for (int i = 0; i < 7; ++i) {
      const auto value = number(columns[i + 1]);
      if (!value) return std::nullopt;
      values[i] = *value;
    }
    const Eigen::Map<const Eigen::Vector3d> position(values);
    const double* q = values + 3;
    const Eigen::Quaterniond rotation = format == TrajectoryFormat::kTum
                                            ? Eigen::Quaterniond(q[3], q[0], q[1], q[2])
                                            : Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    if (std::abs(rotation.norm() - 1) > kRotationTolerance) {
      problem(fmt::format("quaternion of norm {:.3g}", rotation.norm()), "a unit quaternion");
      return std::nullopt;
    }
    pose.T.linear() = rotation.normalized().toRotationMatrix();
    pose.T.translation() = position;
    return pose;
  }

  std::optional<int64_t> stamp_of_seconds(std::string_view column) {
    // A double holds an epoch time to 240 ns only; long double keeps the nanosecond.
    const auto seconds = number_of<long double>(column);
    if (!seconds || std::abs(*seconds) > 9e9L) {
      problem(column, "a time in seconds");
      return std::nullopt;
    }
    return std::llround(*seconds * 1e9L);
  }

  std::optional<int64_t> stamp_of_nanoseconds(std::string_view column) {
    if (const auto stamp_ns = number_of<int64_t>(column)) return stamp_ns;
    // Some tools write nanoseconds as 1.40371552491214310e+18.
    const auto nanoseconds = number_of<long double>(column);
    if (!nanoseconds || std::abs(*nanoseconds) > 9e18L) {
      problem(column, "a time in nanoseconds");
      return std::nullopt;
    }
    return std::llround(*nanoseconds);
  }

  void append(const slam::StampedPose& pose, const std::string& line, slam::Trajectory& poses) {
    if (order_ == StampOrder::kRising && !poses.empty() && pose.stamp_ns < poses.back().stamp_ns) {
      problem(line, "a time not before that of the line above");
      return;
    }
    poses.push_back(pose);
  }

  std::string file_;
  StampOrder order_;
  std::ifstream in_;
  int line_ = 0;
  int64_t poses_read_ = 0;
  std::vector<Problem> problems_;
};

void write_lines(const std::string& file, const slam::Trajectory& poses,
                 std::string (*line_of)(const slam::StampedPose&)) {
  std::ofstream out(file, std::ios::binary);
  for (const slam::StampedPose& pose : poses) out << line_of(pose) << '\n';
  out.close();
  if (!out) throw InputError(Problem{file, 0, "", "cannot be written", "a file in a writable folder"});
}

std::string kitti_line(const slam::StampedPose& pose) {
  std::string line;
  for (int i = 0; i < 12; ++i) {
    line += fmt::format("{}{:.12e}", i == 0 ? "" : " ", pose.T.matrix()(i / 4, i % 4));
  }
  return line;
}

}  // namespace

TrajectoryFile read_trajectory(const std::string& file, TrajectoryFormat format) {
  return Reader(file).read(format);
}

TrajectoryFile read_trajectory(const std::string& file, StampOrder order) {
  return Reader(file, order).read(std::nullopt);
}

std::string tum_line(const slam::StampedPose& pose) {
  constexpr int64_t kSecond = 1'000'000'000;
  const auto magnitude_ns = static_cast<uint64_t>(std::abs(pose.stamp_ns));
  const Eigen::Vector3d p = pose.T.translation();
  Eigen::Quaterniond q(pose.T.linear());
  q.normalize();
  return fmt::format("{}{}.{:09} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f}",
                     pose.stamp_ns < 0 ? "-" : "", magnitude_ns / kSecond, magnitude_ns % kSecond, p.x(),
                     p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

void write_tum(const std::string& file, const slam::Trajectory& poses) { write_lines(file, poses, tum_line); }

void write_kitti(const std::string& file, const slam::Trajectory& poses) {
  write_lines(file, poses, kitti_line);
}

}  // namespace groundloop::bench
