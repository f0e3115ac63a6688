#pragma once

#include <mujoco/mujoco.h>

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "sim/truth/truth_world.h"
#include "slam/types/occupancy_map.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// What a pinhole camera truly sees at one moment, pixel by pixel: the source of every other exact image.
/// Whoever made it: sim::Renderer::render_truth (fast), or cast_image_truth (Bullet's rays, independent).
struct ImageTruth {
  double focal_px = 0, cx_px = 0, cy_px = 0;
  slam::Pose T_world_camera = slam::Pose::Identity();  ///< x right, y down, z forward
  cv::Mat depth_m;  ///< CV_32FC1: z of the surface at the pixel's centre; infinite where there is none
  cv::Mat geom;     ///< CV_32SC1: MuJoCo geom id of that surface; -1 where there is none
  std::vector<slam::Pose> T_world_geom;  ///< of every geom of the model at that moment
};

/// Poses of all geoms in a state with positions computed.
std::vector<slam::Pose> geom_poses(const mjModel& model, const mjData& state);

/// The truth of an image by one ray a pixel.
/// @param view  intrinsics, pose and geom poses are taken from it; its images are filled in
/// @param truth  as the scene stands in the view's moment
void cast_image_truth(const TruthWorld& truth, cv::Size size, ImageTruth& view);

/// focal * baseline / depth of the left image [px] (CV_32FC1); 0 where nothing is seen.
cv::Mat true_disparity_px(const ImageTruth& left, double baseline_m);

/// Where the surfaces of one image are in another: of another camera, or at another moment.
struct ImageMotion {
  cv::Mat flow_px;  ///< CV_32FC2: pixel in `to` minus pixel in `from`; NaN where nothing is seen, or the
                    ///< surface is behind the camera of `to`
  cv::Mat visible;  ///< CV_8UC1: 255 where `to` sees the surface point: inside its image, and nothing nearer
                    ///< within a pixel of it
  cv::Mat moving;   ///< CV_8UC1: 255 where the surface itself moves in the world by more than 1 um
};

/// Exact: from depth, both camera poses, and the motion of the geom that each pixel shows.
ImageMotion image_motion(const ImageTruth& from, const ImageTruth& to);

/// Part of what `from` sees that `to` sees, too, in [0, 1]; 0 when `from` sees nothing.
double true_overlap(const ImageTruth& from, const ImageTruth& to);

/// Instance of every pixel (CV_32SC1): the body that the geom belongs to, a chair with its legs, or a wheel;
/// 0 is the world itself, -1 nothing.
cv::Mat instances(const ImageTruth& image, const mjModel& model);

/// Exact occupancy between consecutive heights above the floor; one map a layer, from the lowest up.
/// @param height_m  borders of the layers, ascending, at least two
std::vector<slam::OccupancyMap> occupancy_layers(const TruthWorld& truth, const slam::GridGeometry& geometry,
                                                 const std::vector<double>& height_m);

}  // namespace groundloop::sim
