#include "sim/render/renderer.h"

#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <array>
#include <limits>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/render/culling.h"
#include "sim/render/gl_context.h"

namespace groundloop::sim {
namespace {

/// Room for what MuJoCo may draw beside the model's geoms (skins, tendons, flex of equality constraints).
constexpr int kExtraGeoms = 1000;
/// Geom groups 0..2 are visible; 3 and above hold geometry for collisions only.
constexpr int kVisibleGroups = 3;

/// The model with the drawing options of one renderer; shares all arrays with the world's.
mjModel with_options(const mjModel& model, int width_px, int height_px, const RenderSettings& settings) {
  mjModel view = model;
  view.vis.global.offwidth = width_px;
  view.vis.global.offheight = height_px;
  view.vis.quality.offsamples = settings.antialiasing;
  if (!settings.shadows) view.vis.quality.shadowsize = 0;
  return view;
}

mjvOption geoms_only() {
  mjvOption option;
  mjv_defaultOption(&option);
  for (int group = 0; group < mjNGROUP; ++group) {
    option.geomgroup[group] = group < kVisibleGroups ? 1 : 0;
    option.sitegroup[group] = 0;
    option.jointgroup[group] = 0;
    option.tendongroup[group] = 0;
    option.actuatorgroup[group] = 0;
  }
  std::fill_n(option.flags, mjNVISFLAG, 0);
  option.flags[mjVIS_TEXTURE] = 1;
  option.flags[mjVIS_STATIC] = 1;
  option.flags[mjVIS_SKIN] = 1;
  option.flags[mjVIS_TRANSPARENT] = 0;
  return option;
}

/// MuJoCo asks for trilinear filtering of everything.
void set_filter(const GlContext& gl, const mjrContext& context, TextureFilter filter) {
  if (filter == TextureFilter::kTrilinear) return;
  const auto bind = gl.function<void(GLenum, GLuint)>("glBindTexture");
  const auto set = gl.function<void(GLenum, GLenum, GLint)>("glTexParameteri");
  for (int i = 0; i < context.ntexture; ++i) {
    const GLenum kind = context.textureType[i] == mjTEXTURE_2D ? GL_TEXTURE_2D : GL_TEXTURE_CUBE_MAP;
    bind(kind, context.texture[i]);
    set(kind, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    bind(kind, 0);
  }
}

void set_vector(float* to, const Eigen::Vector3d& from) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}

}  // namespace

struct Renderer::Impl {
  Impl(const World& world, int width, int height, const RenderSettings& settings)
      : width_px(width),
        height_px(height),
        model(with_options(world.model(), width, height, settings)),
        near_m(model.vis.map.znear * model.stat.extent),
        far_m(model.vis.map.zfar * model.stat.extent),
        gl(make_gl_context()),
        option(geoms_only()),
        rgb(3 * static_cast<size_t>(width) * height) {
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
    mjv_makeScene(&model, &scene, model.ngeom + kExtraGeoms);
    mjr_makeContext(&model, &context, mjFONTSCALE_100);
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
    set_filter(*gl, context, settings.textures);
    scene.flags[mjRND_SHADOW] = settings.shadows ? 1 : 0;
    scene.flags[mjRND_REFLECTION] = settings.reflections ? 1 : 0;
    scene.flags[mjRND_HAZE] = 0;
  }

  ~Impl() {
    gl->make_current();
    mjr_freeContext(&context);
    mjv_freeScene(&scene);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void update(const mjData& data, const LightFactors& lights) {
    mjvCamera camera;  // replaced for every image
    mjv_defaultCamera(&camera);
    // MuJoCo reads the state only, but takes it as non-const.
    mjv_updateScene(&model, const_cast<mjData*>(&data), &option, nullptr, &camera, mjCAT_ALL, &scene);
    geoms.assign(scene.geoms, scene.geoms + scene.ngeom);
    if (!lights.light.empty()) dim(lights);
  }

  /// The scene holds the head-light first, then the model's active lights in their order.
  void dim(const LightFactors& lights) {
    const auto scale = [](mjvLight& light, float factor) {
      for (float* colour : {light.ambient, light.diffuse, light.specular}) {
        for (int i = 0; i < 3; ++i) colour[i] *= factor;
      }
    };
    int next = 0;
    if (model.vis.headlight.active != 0) scale(scene.lights[next++], lights.ambient);
    for (int light = 0; light < model.nlight && next < scene.nlight; ++light) {
      if (model.light_active[light] != 0)
        scale(scene.lights[next++], lights.light[static_cast<size_t>(light)]);
    }
  }

  void render(const Camera& camera) {
    gl->make_current();
    aim(camera);
    keep_visible(camera);
    mjr_render(viewport(), &scene, &context);
  }

  /// The frustum through the corners of the image, from -0.5 to width - 0.5. MuJoCo takes the frustum's
  /// horizontal size from the viewport, its centre from the camera; both of its cameras are averaged.
  void aim(const Camera& camera) {
    const double scale = near_m / camera.focal_px;
    const Eigen::Matrix3d R_world_camera = camera.T_world_camera.linear();
    for (mjvGLCamera& gl_camera : scene.camera) {
      set_vector(gl_camera.pos, camera.T_world_camera.translation());
      set_vector(gl_camera.forward, R_world_camera.col(2));
      set_vector(gl_camera.up, -R_world_camera.col(1));
      gl_camera.frustum_center = static_cast<float>(scale * (0.5 * (width_px - 1) - camera.cx_px));
      gl_camera.frustum_top = static_cast<float>(scale * (camera.cy_px + 0.5));
      gl_camera.frustum_bottom = static_cast<float>(-scale * (height_px - 0.5 - camera.cy_px));
      gl_camera.frustum_near = static_cast<float>(near_m);
      gl_camera.frustum_far = static_cast<float>(far_m);
    }
  }

  /// Leaves the geoms in the scene that this image can show: MuJoCo draws whatever it is given. A geom behind
  /// the camera may still throw a shadow into the image.
  void keep_visible(const Camera& camera) {
    const double scale = 1 / camera.focal_px;
    const std::array<HalfSpace, 4> pyramid =
        view_pyramid(camera.T_world_camera.translation(), camera.T_world_camera.linear(),
                     {-scale * (camera.cx_px + 0.5), scale * (width_px - 0.5 - camera.cx_px),
                      -scale * (camera.cy_px + 0.5), scale * (height_px - 0.5 - camera.cy_px)});
    const std::vector<HalfSpace> mirrors = mirror_planes();
    const auto visible = [&](const mjvGeom& geom) {
      if (scene.flags[mjRND_SHADOW] || geom.objtype != mjOBJ_GEOM || model.geom_rbound[geom.objid] <= 0)
        return true;
      return may_be_seen(Eigen::Map<const Eigen::Vector3f>(geom.pos).cast<double>(),
                         model.geom_rbound[geom.objid], pyramid, mirrors);
    };
    scene.ngeom =
        static_cast<int>(std::copy_if(geoms.begin(), geoms.end(), scene.geoms, visible) - scene.geoms);
  }

  /// The faces in which MuJoCo may reflect: the +z sides of planes and boxes.
  std::vector<HalfSpace> mirror_planes() const {
    std::vector<HalfSpace> mirrors;
    for (const mjvGeom& geom : geoms) {
      if (!scene.flags[mjRND_REFLECTION] || geom.reflectance <= 0) continue;
      const Eigen::Vector3d n(geom.mat[2], geom.mat[5], geom.mat[8]);
      const double thickness_m = geom.type == mjGEOM_BOX ? geom.size[2] : 0;
      const Eigen::Vector3d centre = Eigen::Map<const Eigen::Vector3f>(geom.pos).cast<double>();
      mirrors.push_back({n, n.dot(centre) + thickness_m});
    }
    return mirrors;
  }

  void need_single_samples(const char* what) const {
    if (context.offSamples == 0) return;
    throw std::logic_error(std::string("Renderer::") + what + " needs a renderer without antialiasing");
  }

  /// z along the optical axis from the depth buffer; rows top-down.
  void metres(const cv::Mat& bottom_up, cv::Mat& depth_m) const {
    depth_m.create(bottom_up.size(), CV_32FC1);
    const double shrink = 1 - near_m / far_m;
    for (int row = 0; row < depth_m.rows; ++row) {
      const float* from = bottom_up.ptr<float>(depth_m.rows - 1 - row);
      float* to = depth_m.ptr<float>(row);
      for (int col = 0; col < depth_m.cols; ++col) {
        to[col] = static_cast<float>(near_m / (1 - from[col] * shrink));
      }
    }
  }

  /// Geom ids from the colours that MuJoCo draws in place of them: the place in the scene, from 1.
  void geom_ids(cv::Mat& geom) const {
    std::vector<int> id_of(geoms.size() + 1, -1);
    for (const mjvGeom& drawn : geoms) {
      const auto colour = static_cast<size_t>(drawn.segid + 1);
      if (drawn.objtype == mjOBJ_GEOM && colour < id_of.size()) id_of[colour] = drawn.objid;
    }
    geom.create(height_px, width_px, CV_32SC1);
    for (int row = 0; row < height_px; ++row) {
      const unsigned char* from = &rgb[3 * static_cast<size_t>(height_px - 1 - row) * width_px];
      int* to = geom.ptr<int>(row);
      for (int col = 0; col < width_px; ++col, from += 3) {
        to[col] = id_of[from[0] + (static_cast<size_t>(from[1]) << 8) + (static_cast<size_t>(from[2]) << 16)];
      }
    }
  }

  mjrRect viewport() const { return {0, 0, width_px, height_px}; }

  const int width_px, height_px;
  const mjModel model;
  const double near_m, far_m;
  std::unique_ptr<GlContext> gl;
  const mjvOption option;
  mjvScene scene;
  mjrContext context;
  std::vector<mjvGeom> geoms;      ///< of the whole state; scene.geoms holds those of one image
  std::vector<unsigned char> rgb;  ///< as OpenGL delivers it: rows bottom-up
};

Renderer::Renderer(const World& world, int width_px, int height_px, const RenderSettings& settings)
    : impl_(std::make_unique<Impl>(world, width_px, height_px, settings)) {}

Renderer::~Renderer() = default;

void Renderer::update_scene(const mjData& data, const LightFactors& lights) { impl_->update(data, lights); }

void Renderer::render_grey(const Camera& camera, cv::Mat& grey) {
  impl_->render(camera);
  mjr_readPixels(impl_->rgb.data(), nullptr, impl_->viewport(), &impl_->context);
  grey.create(impl_->height_px, impl_->width_px, CV_8UC1);
  for (int row = 0; row < grey.rows; ++row) {
    const unsigned char* from = &impl_->rgb[3 * static_cast<size_t>(grey.rows - 1 - row) * grey.cols];
    uchar* to = grey.ptr(row);
    // Rec. 601 luma in fixed point: 0.299 R + 0.587 G + 0.114 B, rounded.
    for (int col = 0; col < grey.cols; ++col, from += 3) {
      to[col] = static_cast<uchar>((77 * from[0] + 150 * from[1] + 29 * from[2] + 128) >> 8);
    }
  }
}

void Renderer::render_bgr(const Camera& camera, cv::Mat& bgr) {
  impl_->render(camera);
  mjr_readPixels(impl_->rgb.data(), nullptr, impl_->viewport(), &impl_->context);
  bgr.create(impl_->height_px, impl_->width_px, CV_8UC3);
  for (int row = 0; row < bgr.rows; ++row) {
    const unsigned char* from = &impl_->rgb[3 * static_cast<size_t>(bgr.rows - 1 - row) * bgr.cols];
    uchar* to = bgr.ptr(row);
    for (int col = 0; col < bgr.cols; ++col, from += 3, to += 3) {
      to[0] = from[2];
      to[1] = from[1];
      to[2] = from[0];
    }
  }
}

void Renderer::render_depth(const Camera& camera, cv::Mat& depth_m) {
  impl_->need_single_samples("render_depth");
  impl_->render(camera);
  cv::Mat bottom_up(impl_->height_px, impl_->width_px, CV_32FC1);
  mjr_readPixels(nullptr, bottom_up.ptr<float>(), impl_->viewport(), &impl_->context);
  impl_->metres(bottom_up, depth_m);
}

void Renderer::render_truth(const Camera& camera, cv::Mat& depth_m, cv::Mat& geom) {
  impl_->need_single_samples("render_truth");
  impl_->scene.flags[mjRND_SEGMENT] = impl_->scene.flags[mjRND_IDCOLOR] = 1;
  impl_->render(camera);
  impl_->scene.flags[mjRND_SEGMENT] = impl_->scene.flags[mjRND_IDCOLOR] = 0;
  cv::Mat bottom_up(impl_->height_px, impl_->width_px, CV_32FC1);
  mjr_readPixels(impl_->rgb.data(), bottom_up.ptr<float>(), impl_->viewport(), &impl_->context);
  impl_->metres(bottom_up, depth_m);
  impl_->geom_ids(geom);
  depth_m.setTo(std::numeric_limits<float>::infinity(), geom < 0);
}

RendererInfo Renderer::info() const {
  impl_->gl->make_current();
  return {impl_->gl->backend(), impl_->gl->renderer(), impl_->gl->version(), impl_->context.offSamples};
}

RendererInfo renderer_info(const RenderSettings& settings) {
  const std::unique_ptr<GlContext> gl = make_gl_context();
  return {gl->backend(), gl->renderer(), gl->version(), gl->samples_for(settings.antialiasing)};
}

}  // namespace groundloop::sim
