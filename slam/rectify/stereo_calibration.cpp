#include "slam/rectify/stereo_calibration.h"

#include <fmt/format.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <utility>

#include "slam/types/config.h"

namespace groundloop::slam {
namespace {

/// OpenCV's way to write a matrix (tag !!opencv-matrix).
struct MatrixNode {
  int rows = 0, cols = 0;
  std::string dt = "d";
  std::vector<double> data;

  template <class Archive>
  void visit(Archive& a) {
    a("rows", rows, {.min = 1, .max = 100, .required = true});
    a("cols", cols, {.min = 1, .max = 100, .required = true});
    a("dt", dt);
    a("data", data, {.required = true});
  }
  void check(ConfigReader& reader) const {
    if (data.size() != static_cast<size_t>(rows) * static_cast<size_t>(cols)) {
      reader.problem("data", fmt::format("{} numbers", data.size()),
                     fmt::format("{}, in {} rows of {}", rows * cols, rows, cols));
    }
  }
  template <int kRows, int kCols>
  cv::Matx<double, kRows, kCols> matrix() const {
    return cv::Matx<double, kRows, kCols>(data.data());
  }
};

/// The keys of interest in one or more files.
struct CalibrationNode {
  int image_width = 0, image_height = 0;
  std::optional<MatrixNode> M1, D1, M2, D2, R, T, R1, R2, P1, P2;

  template <class Archive>
  void visit(Archive& a) {
    a("image_width", image_width, {.min = 1, .max = 65536});
    a("image_height", image_height, {.min = 1, .max = 65536});
    for_each([&](const char* key, auto& matrix) { a(key, matrix); });
  }
  template <class Visit>
  void for_each(const Visit& visit) {
    visit("M1", M1), visit("D1", D1), visit("M2", M2), visit("D2", D2), visit("R", R), visit("T", T);
    visit("R1", R1), visit("R2", R2), visit("P1", P1), visit("P2", P2);
  }
  void check(ConfigReader& reader) const {
    for (const auto& [key, matrix] : {std::pair("M1", &M1), std::pair("M2", &M2)}) {
      if (shaped(reader, key, *matrix, 3, 3) && !is_camera((*matrix)->matrix<3, 3>())) {
        reader.problem(key, "a camera matrix: fx, 0, cx; 0, fy, cy; 0, 0, 1, fx and fy above 0");
      }
    }
    for (const auto& [key, matrix] : {std::pair("R", &R), std::pair("R1", &R1), std::pair("R2", &R2)}) {
      if (shaped(reader, key, *matrix, 3, 3) && !is_rotation((*matrix)->matrix<3, 3>())) {
        reader.problem(key, "a rotation");
      }
    }
    for (const auto& [key, matrix] : {std::pair("P1", &P1), std::pair("P2", &P2)}) {
      shaped(reader, key, *matrix, 3, 4);
    }
    shaped(reader, "T", T, 3, 1);
    for (const auto& [key, matrix] : {std::pair("D1", &D1), std::pair("D2", &D2)}) {
      const size_t n = *matrix && reader.has(key) ? (*matrix)->data.size() : 4;
      if (n != 4 && n != 5 && n != 8) {
        reader.problem(key, fmt::format("{} numbers", n), "k1, k2, p1, p2, perhaps k3, perhaps k4, k5, k6");
      }
    }
  }
  static bool shaped(ConfigReader& reader, const char* key, const std::optional<MatrixNode>& matrix, int rows,
                     int cols) {
    if (!matrix || !reader.has(key)) return false;
    const bool good = matrix->rows == rows && matrix->cols == cols &&
                      matrix->data.size() == static_cast<size_t>(rows) * static_cast<size_t>(cols);
    if (!good) {
      reader.problem(key, fmt::format("{} x {}", matrix->rows, matrix->cols),
                     fmt::format("a {} x {} matrix", rows, cols));
    }
    return good;
  }
  static bool is_camera(const cv::Matx33d& M) {
    return M(0, 0) > 0 && M(1, 1) > 0 && M(0, 1) == 0 && M(1, 0) == 0 && M(2, 0) == 0 && M(2, 1) == 0 &&
           M(2, 2) == 1;
  }
  static bool is_rotation(const cv::Matx33d& M) {
    return cv::norm(M * M.t() - cv::Matx33d::eye()) < 1e-3 && cv::determinant(M) > 0;
  }
};

/// OpenCV begins its files with "%YAML:1.0", which YAML itself does not know.
std::string without_directive(std::string text) {
  if (text.starts_with("%YAML")) text.replace(0, text.find('\n'), "#");
  return text;
}

void read_text(const std::string& text, const std::string& name, CalibrationNode& node,
               std::vector<Problem>& problems) {
  YAML::Node root;
  try {
    root = YAML::Load(without_directive(text));
  } catch (const YAML::Exception& error) {
    problems.push_back({name, error.mark.line + 1, "", error.msg, "a YAML file as OpenCV writes it"});
    return;
  }
  // Not finished: calibrations hold more keys than these.
  ConfigReader reader(root, name, "", &problems);
  const size_t before = problems.size();
  node.visit(reader);
  if (problems.size() == before) node.check(reader);
}

std::string joined(const std::vector<std::string>& files) {
  std::string text;
  for (const std::string& file : files) text += (text.empty() ? "" : " + ") + file;
  return text;
}

StereoCalibration made_of(CalibrationNode& node, const std::string& name, std::vector<Problem> problems) {
  const bool has_pose = node.R && node.T, has_choice = node.R1 && node.R2 && node.P1 && node.P2;
  const bool readable = problems.empty();
  node.for_each([&](const std::string& key, const std::optional<MatrixNode>& matrix) {
    const bool wanted = key[0] == 'M' || key[0] == 'D' || (!has_choice && (key == "R" || key == "T"));
    if (readable && wanted && !matrix) {
      problems.push_back({name, 0, key, "missing", "M1, D1, M2, D2 and R, T (or R1, R2, P1, P2)"});
    }
  });
  if (!problems.empty()) throw InputError(std::move(problems));

  StereoCalibration result;
  result.file = name;
  if (node.image_width > 0 && node.image_height > 0)
    result.size = cv::Size(node.image_width, node.image_height);
  result.M1 = node.M1->matrix<3, 3>(), result.M2 = node.M2->matrix<3, 3>();
  result.D1 = node.D1->data, result.D2 = node.D2->data;
  if (has_pose) {
    result.R = node.R->matrix<3, 3>();
    result.T = cv::Vec3d(node.T->data.data());
  }
  if (has_choice) {
    result.chosen = {node.R1->matrix<3, 3>(), node.R2->matrix<3, 3>(), node.P1->matrix<3, 4>(),
                     node.P2->matrix<3, 4>()};
  }
  return result;
}

}  // namespace

StereoCalibration parse_stereo_calibration(const std::string& text, const std::string& name) {
  CalibrationNode node;
  std::vector<Problem> problems;
  read_text(text, name, node, problems);
  return made_of(node, name, std::move(problems));
}

StereoCalibration read_stereo_calibration(const std::vector<std::string>& files) {
  CalibrationNode node;
  std::vector<Problem> problems;
  for (const std::string& file : files) {
    std::ifstream in(file);
    std::ostringstream text;
    if (in && in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
    if (text.str().empty()) {
      problems.push_back({file, 0, "", "cannot be read", "a stereo calibration in OpenCV's YAML"});
    } else {
      read_text(text.str(), file, node, problems);
    }
  }
  return made_of(node, joined(files), std::move(problems));
}

}  // namespace groundloop::slam
