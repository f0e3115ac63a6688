#include "slam/source/euroc_source.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <utility>

#include "slam/source/image_file.h"
#include "slam/source/text.h"
#include "slam/types/config.h"

namespace groundloop::slam {
namespace {

/// What sensor.yaml says of one camera; keys as in the EuRoC data sets.
struct CameraFile {
  struct Matrix {
    int cols = 0, rows = 0;
    std::vector<double> data;

    template <class Archive>
    void visit(Archive& a) {
      a("cols", cols);
      a("rows", rows);
      a("data", data, {.required = true});
    }
    void check(ConfigReader& reader) const {
      if (data.size() != 16)
        reader.problem("data", "16 numbers, 4 rows of 4");
      else if (!is_rigid())
        reader.problem("data", "a rigid motion: rotation and translation over 0, 0, 0, 1");
    }
    Eigen::Matrix4d matrix() const {
      return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(data.data());
    }
    bool is_rigid() const {
      const Eigen::Matrix3d R = matrix().topLeftCorner<3, 3>();
      return (R * R.transpose()).isIdentity(1e-3) && R.determinant() > 0 &&
             matrix().row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1));
    }
  };
  Matrix T_BS;  ///< takes points of the camera to the body of the vehicle
  std::string camera_model = "pinhole", distortion_model = "radial-tangential";
  std::vector<double> intrinsics;               ///< fx, fy, cx, cy [px]
  std::vector<double> distortion_coefficients;  ///< k1, k2, p1, p2 (, k3)
  std::vector<int> resolution;                  ///< width, height [px]

  template <class Archive>
  void visit(Archive& a) {
    a("T_BS", T_BS, {.required = true});
    a("resolution", resolution, {.min = 1, .required = true});
    a("camera_model", camera_model);
    a("intrinsics", intrinsics, {.required = true});
    a("distortion_model", distortion_model);
    a("distortion_coefficients", distortion_coefficients, {.required = true});
  }
  void check(ConfigReader& reader) const {
    const auto need = [&](const char* key, bool good, const char* wanted) {
      if (reader.has(key) && !good) reader.problem(key, wanted);
    };
    need("resolution", resolution.size() == 2, "width and height in pixels");
    need("camera_model", camera_model == "pinhole", "pinhole");
    need("intrinsics", intrinsics.size() == 4 && intrinsics[0] > 0 && intrinsics[1] > 0,
         "fx, fy, cx, cy in pixels, fx and fy above 0");
    need("distortion_model", distortion_model == "radial-tangential", "radial-tangential");
    need("distortion_coefficients",
         distortion_coefficients.size() == 4 || distortion_coefficients.size() == 5,
         "k1, k2, p1, p2 and perhaps k3");
  }

  cv::Matx33d camera_matrix() const {
    return {intrinsics[0], 0, intrinsics[2], 0, intrinsics[1], intrinsics[3], 0, 0, 1};
  }
  cv::Size size() const { return {resolution[0], resolution[1]}; }
};

CameraFile read_camera(const std::string& file, std::vector<Problem>& problems) {
  CameraFile camera;
  try {
    // The root map is not finished: data sets add keys of their own, such as sensor_type and rate_hz.
    ConfigReader reader(load_yaml_file(file), file, "", &problems);
    camera.visit(reader);
    camera.check(reader);
  } catch (const InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  }
  return camera;
}

/// Stamp [ns] -> image file of data.csv.
std::map<int64_t, std::string> read_stamps(const std::string& folder, std::vector<Problem>& problems) {
  const std::string file = folder + "/data.csv";
  std::map<int64_t, std::string> images;
  try {
    for (const TextLine& line : read_lines(file, "lines of stamp in ns and file name")) {
      const auto words = split(line.text, ", \t");
      const auto stamp_ns = to_int64(words.front());
      if (!stamp_ns || words.size() != 2) {
        problems.push_back({file, line.number, "", line.text, "stamp in ns, file name"});
      } else {
        images[*stamp_ns] = folder + "/data/" + std::string(words[1]);
      }
    }
  } catch (const InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  }
  return images;
}

/// The calibration that the two sensor.yaml hold.
StereoCalibration calibration_of(const CameraFile& left, const CameraFile& right, const std::string& file) {
  const Eigen::Matrix4d T_right_left = right.T_BS.matrix().inverse() * left.T_BS.matrix();
  StereoCalibration result{file,
                           left.size(),
                           left.camera_matrix(),
                           right.camera_matrix(),
                           left.distortion_coefficients,
                           right.distortion_coefficients,
                           {},
                           {},
                           std::nullopt};
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) result.R(row, col) = T_right_left(row, col);
    result.T[row] = T_right_left(row, 3);
  }
  return result;
}

/// Of both cameras.
StereoCalibration read_cameras(const std::string& left_folder, const std::string& right_folder,
                               std::vector<Problem>& problems) {
  const size_t before = problems.size();
  const std::string right_file = right_folder + "/sensor.yaml";
  const CameraFile left = read_camera(left_folder + "/sensor.yaml", problems);
  const CameraFile right = read_camera(right_file, problems);
  if (problems.size() > before) return {};
  if (left.size() != right.size()) {
    problems.push_back({right_file, 0, "resolution",
                        fmt::format("{}x{}", right.resolution[0], right.resolution[1]),
                        fmt::format("{}x{} as cam0", left.resolution[0], left.resolution[1])});
  }
  return calibration_of(left, right, right_file);
}

}  // namespace

EurocSource::EurocSource(const std::string& directory, const SourceOptions& options) {
  const bool has_mav0 = std::filesystem::is_directory(directory + "/mav0");
  const std::string base = has_mav0 ? directory + "/mav0" : directory;
  const std::string left_folder = base + "/cam0", right_folder = base + "/cam1";
  std::vector<Problem> problems;
  StereoCalibration calibration;
  if (options.calibration_files.empty()) calibration = read_cameras(left_folder, right_folder, problems);
  const auto left_images = read_stamps(left_folder, problems);
  const auto right_images = read_stamps(right_folder, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  if (!options.calibration_files.empty()) calibration = read_stereo_calibration(options.calibration_files);

  for (const auto& [stamp_ns, left_file] : left_images) {
    const auto found = right_images.find(stamp_ns);
    if (found == right_images.end()) continue;
    stamps_ns_.push_back(stamp_ns);
    left_files_.push_back(left_file);
    right_files_.push_back(found->second);
  }
  if (stamps_ns_.empty()) {
    throw InputError(
        Problem{right_folder + "/data.csv", 0, "", "no stamp of cam0", "stamps that both cameras have"});
  }

  rectifier_.emplace(calibration,
                     calibration.size ? *calibration.size : read_grey_image(left_files_.front()).size());
  rig_ = rectifier_->rig();
  rig_.T_body_left = StereoRig::level_camera({0, 0, options.camera_height_m});
}

std::optional<StereoFrame> EurocSource::next() {
  if (next_ == size()) return std::nullopt;
  StereoFrame frame;
  frame.index = next_;
  frame.stamp_ns = stamps_ns_[next_];
  const cv::Mat left = read_grey_image(left_files_[next_], rig_.width_px, rig_.height_px);
  const cv::Mat right = read_grey_image(right_files_[next_], rig_.width_px, rig_.height_px);
  rectifier_->rectify(left, right, frame);
  ++next_;
  return frame;
}

}  // namespace groundloop::slam
