#include "slam/tracking/rotation_alignment.h"

#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>

#include "slam/types/pose.h"

namespace groundloop::slam {
namespace {

constexpr double kBlurSigma_px = 1.5;
constexpr int kIterations = 20;
constexpr double kConverged_rad = 1e-5;

float sample(const cv::Mat& image, float u, float v) {
  const int iu = static_cast<int>(u), iv = static_cast<int>(v);
  const float fu = u - static_cast<float>(iu), fv = v - static_cast<float>(iv);
  const float* top = image.ptr<float>(iv) + iu;
  const float* bottom = image.ptr<float>(iv + 1) + iu;
  const float upper = top[0] + fu * (top[1] - top[0]);
  const float lower = bottom[0] + fu * (bottom[1] - bottom[0]);
  return upper + fv * (lower - upper);
}

}  // namespace

void RotationAlignment::shrink(const ImagePyramid& pyramid, cv::Mat& small) const {
  pyramid.level(pyramid.levels() - 1).convertTo(small, CV_32F);
  cv::GaussianBlur(small, small, cv::Size(), kBlurSigma_px);
  small -= cv::mean(small)[0];
}

void RotationAlignment::remember(const ImagePyramid& left) { shrink(left, previous_); }

Eigen::Matrix3d RotationAlignment::align(const ImagePyramid& left,
                                         const Eigen::Matrix3d& predicted_R_previous_left) {
  shrink(left, current_);
  if (previous_.size() != current_.size()) return predicted_R_previous_left;
  cv::Sobel(current_, gradient_x_, CV_32F, 1, 0, 1, 0.5);
  cv::Sobel(current_, gradient_y_, CV_32F, 0, 1, 1, 0.5);
  const double scale = 1.0 / (1 << (left.levels() - 1));
  const double fx = rig_.fx_px * scale, fy = rig_.fy_px * scale, cx = rig_.cx_px * scale,
               cy = rig_.cy_px * scale;

  Eigen::Matrix3d R_left_previous = predicted_R_previous_left.transpose();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (int v = 1; v + 1 < previous_.rows; ++v) {
      for (int u = 1; u + 1 < previous_.cols; ++u) {
        const Eigen::Vector3d ray = R_left_previous * Eigen::Vector3d((u - cx) / fx, (v - cy) / fy, 1);
        if (ray.z() < 0.1) continue;
        const double x = ray.x() / ray.z(), y = ray.y() / ray.z();
        const double uu = fx * x + cx, vv = fy * y + cy;
        if (!(uu >= 1 && vv >= 1 && uu < current_.cols - 2 && vv < current_.rows - 2)) continue;
        const auto us = static_cast<float>(uu), vs = static_cast<float>(vv);
        const double r = previous_.at<float>(v, u) - sample(current_, us, vs);
        const double gx = fx * sample(gradient_x_, us, vs), gy = fy * sample(gradient_y_, us, vs);
        // derivative of (x, y) with respect to a left rotation of the ray
        const Eigen::Vector3d J(-gx * x * y - gy * (1 + y * y), gx * (1 + x * x) + gy * x * y,
                                -gx * y + gy * x);
        H += J * J.transpose();
        gradient += J * r;
      }
    }
    H.diagonal().array() += 1e-6 * H.trace() + 1e-12;
    const Eigen::Vector3d step = H.ldlt().solve(gradient);
    if (!step.allFinite() || step.norm() > 0.5) return predicted_R_previous_left;
    R_left_previous = so3_exp(step) * R_left_previous;
    if (step.norm() < kConverged_rad) break;
  }
  return R_left_previous.transpose();
}

}  // namespace groundloop::slam
