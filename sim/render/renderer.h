#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "sim/scenario/render_choice.h"
#include "sim/world/lighting.h"
#include "sim/world/world.h"
#include "slam/types/pose.h"

namespace groundloop::sim {

/// What the renderer is, for run.json and the preflight line.
struct RendererInfo {
  std::string backend;   ///< "OSMesa" or "EGL surfaceless"
  std::string renderer;  ///< GL_RENDERER, names llvmpipe, LLVM version and vector width
  std::string version;   ///< GL_VERSION
  int samples = 0;       ///< what was given, not what was asked for

  bool operator==(const RendererInfo&) const = default;
};

/// What a renderer with these settings would be, without making one.
RendererInfo renderer_info(const RenderSettings& settings);

/// Off-screen renderer with exact intrinsics (free principal point, no head-light). One OpenGL context, to be
/// used by the thread that made it.
class Renderer {
 public:
  Renderer(const World& world, int width_px, int height_px, const RenderSettings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Pinhole camera of one image.
  struct Camera {
    double focal_px, cx_px, cy_px;
    slam::Pose T_world_camera;  ///< x right, y down, z forward
  };

  /// Takes over the state's geometry, and how bright its lights are; call once before the images of that
  /// state.
  void update_scene(const mjData& data, const LightFactors& lights = {});
  /// Renders to 8-bit grey (CV_8UC1, rows top-down).
  void render_grey(const Camera& camera, cv::Mat& grey);
  /// Renders to 8-bit BGR, for pictures.
  void render_bgr(const Camera& camera, cv::Mat& bgr);
  /// Renders z along the optical axis [m] (CV_32FC1); the far plane where there is nothing. Needs
  /// `antialiasing: 0`, since MuJoCo resolves multisampled depth by picking a sample.
  void render_depth(const Camera& camera, cv::Mat& depth_m);
  /// What each pixel truly shows: depth as above, but infinite where there is nothing, and the geom's id
  /// (CV_32SC1, -1 where there is nothing), in one pass without lights or textures. What is transparent is
  /// seen like anything else. Needs `antialiasing: 0`.
  void render_truth(const Camera& camera, cv::Mat& depth_m, cv::Mat& geom);

  RendererInfo info() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace groundloop::sim
