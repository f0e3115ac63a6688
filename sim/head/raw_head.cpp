#include "sim/head/raw_head.h"

#include <numbers>
#include <opencv2/core.hpp>

namespace groundloop::sim {

slam::Pose T_left_right(double baseline_m, const RightPose& pose) {
  // camera axes: x right, y down, z forward
  const auto turn = [](double angle_deg, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180, axis);
  };
  return slam::Pose(Eigen::Translation3d(baseline_m, pose.down_m, pose.forward_m) *
                    turn(-pose.pan_deg, Eigen::Vector3d::UnitY()) *
                    turn(pose.tilt_deg, Eigen::Vector3d::UnitX()) *
                    turn(pose.roll_deg, Eigen::Vector3d::UnitZ()));
}

ReadPixels read_pixels(const SensorModel& sensor, int width_px, int height_px) {
  return {read_pixels(width_px, sensor.reduction, sensor.factor, sensor.mosaic),
          read_pixels(height_px, sensor.reduction, sensor.factor, sensor.mosaic), sensor.mosaic};
}

RawCamera::RawCamera(const RawHead& head, int width_px, int height_px, int camera)
    : head_(head),
      pixels_(read_pixels(head.sensor, width_px, height_px)),
      view_(render_view(head.optics, pixels_)),
      lens_(head.optics, camera, pixels_, view_),
      sensor_(head.sensor, pixels_.size(), camera) {}

void RawCamera::integrate(const std::vector<cv::Mat>& levels, const ExposureSetting& setting,
                          cv::Mat& level) const {
  CV_Assert(static_cast<int>(levels.size()) == head_.exposure.sub_frames);
  level = cv::Mat::zeros(levels.front().size(), CV_32FC1);
  for (int row = 0; row < level.rows; ++row) {
    const std::vector<float> weights = shutter_weights(head_.exposure, setting.time_s, row, level.rows);
    float* const to = level.ptr<float>(row);
    for (size_t k = 0; k < levels.size(); ++k) {
      if (weights[k] == 0) continue;
      const float* const from = levels[k].ptr<float>(row);
      for (int col = 0; col < level.cols; ++col) to[col] += weights[k] * from[col];
    }
  }
}

void RawCamera::read_out(const cv::Mat& level, const ExposureSetting& setting, uint64_t seed, int64_t frame,
                         cv::Mat& image) const {
  sensor_.read_out(level, setting, seed, frame, image);
  if (head_.sensor.reduction == Reduction::kBinning) image = binned(image, head_.sensor.factor);
}

int RawCamera::sensor_pixels_per_px() const {
  return head_.sensor.reduction == Reduction::kBinning ? head_.sensor.factor : 1;
}

}  // namespace groundloop::sim
