#pragma once

#include "sim/head/exposure.h"
#include "sim/head/optics.h"
#include "sim/head/sensor.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// How the right camera sits on the left one, beyond the baseline: its centre in the left camera's axes, then
/// turns about it (pan to the left, tilt up, roll right side down).
struct RightPose {
  double down_m = 0;
  double forward_m = 0;
  double pan_deg = 0;
  double tilt_deg = 0;
  double roll_deg = 0;

  template <class Archive>
  void visit(Archive& a) {
    a("down_m", down_m, {.min = -0.1, .max = 0.1});
    a("forward_m", forward_m, {.min = -0.1, .max = 0.1});
    a("pan_deg", pan_deg, {.min = -20, .max = 20});
    a("tilt_deg", tilt_deg, {.min = -20, .max = 20});
    a("roll_deg", roll_deg, {.min = -20, .max = 20});
  }
};

/// Pose of a right camera in the left one.
slam::Pose T_left_right(double baseline_m, const RightPose& pose);

/// By how much what the core is told of a lens is more than the truth.
struct LensError {
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

  template <class Archive>
  void visit(Archive& a) {
    for (const auto& [key, value] : {std::pair("fx_px", &fx_px), std::pair("fy_px", &fy_px),
                                     std::pair("cx_px", &cx_px), std::pair("cy_px", &cy_px)}) {
      a(key, *value, {.min = -200, .max = 200});
    }
    for (const auto& [key, value] : {std::pair("k1", &k1), std::pair("k2", &k2), std::pair("p1", &p1),
                                     std::pair("p2", &p2), std::pair("k3", &k3)}) {
      a(key, *value, {.min = -1, .max = 1});
    }
  }
};

/// The calibration file that the core is given says the truth plus this.
struct CalibrationError {
  LensError left, right;
  double baseline_m = 0;
  RightPose right_pose;

  template <class Archive>
  void visit(Archive& a) {
    a("left", left);
    a("right", right);
    a("baseline_m", baseline_m, {.min = -0.05, .max = 0.05});
    a("right_pose", right_pose);
  }
};

/// A head whose images are made as a real one's: by lenses, sensors and a shutter. The core gets them raw,
/// with a calibration file.
struct RawHead {
  Optics optics;
  RightPose right_pose;
  SensorModel sensor;
  ExposureModel exposure;
  CalibrationError calibration_error;

  template <class Archive>
  void visit(Archive& a) {
    a("optics", optics);
    a("right_pose", right_pose);
    a("sensor", sensor);
    a("exposure", exposure);
    a("calibration_error", calibration_error);
  }
};

/// One camera of a raw head: rendered pinhole images -> the image that it delivers.
class RawCamera {
 public:
  /// @param width_px, height_px  delivered
  /// @param camera               0 left, 1 right
  /// @throws std::domain_error as render_view()
  RawCamera(const RawHead& head, int width_px, int height_px, int camera);

  /// What to render, from the camera's own pose; the same for both cameras of a head.
  const RenderView& view() const { return view_; }
  /// The rendered images must be in colour.
  bool wants_colour() const { return head_.sensor.mosaic != Mosaic::kNone; }

  /// Light of one sub-frame on the sensor (LensImage::expose).
  void see(const cv::Mat& rendered, cv::Mat& level) const { lens_.expose(rendered, level); }
  /// Light over the whole exposure, row by row as the shutter opens.
  /// @param levels  one for each of ExposureModel::sub_frame_times_s()
  void integrate(const std::vector<cv::Mat>& levels, const ExposureSetting& setting, cv::Mat& level) const;
  /// The delivered image (CV_8UC1; a mosaic stays one). Depends on its arguments alone.
  void read_out(const cv::Mat& level, const ExposureSetting& setting, uint64_t seed, int64_t frame,
                cv::Mat& image) const;
  /// Sensor pixels per delivered pixel along each axis: 1 but for binning.
  int sensor_pixels_per_px() const;

 private:
  RawHead head_;
  ReadPixels pixels_;
  RenderView view_;
  LensImage lens_;
  Sensor sensor_;
};

/// The columns and rows that a head's sensors read out.
ReadPixels read_pixels(const SensorModel& sensor, int width_px, int height_px);

}  // namespace groundloop::sim
