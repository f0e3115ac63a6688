#include "bench/runner/frame_export.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "bench/runner/simulated_source.h"
#include "sim/generate/realize.h"
#include "sim/render/renderer.h"
#include "sim/simulation/carried_head.h"
#include "sim/truth/image_truth.h"
#include "slam/mapping/atomic_file.h"

namespace groundloop::bench {
namespace {

constexpr float kUnknownFlow = 1e10F;  ///< Middlebury's mark

class FrameFolder {
 public:
  explicit FrameFolder(std::string folder) : folder_(std::move(folder)) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error)
      throw InputError(Problem{"", 0, "--out", folder_, "a folder that can be made: " + error.message()});
  }

  void write_png(const char* name, const cv::Mat& image) {
    std::vector<uint8_t> bytes;
    cv::imencode(".png", image, bytes);
    write(name, [&](std::ostream& out) {
      out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    });
  }

  /// Portable float map: rows bottom-up, little-endian.
  void write_pfm(const char* name, const cv::Mat& values) {
    write(name, [&](std::ostream& out) {
      out << "Pf\n" << values.cols << " " << values.rows << "\n-1.0\n";
      for (int row = values.rows - 1; row >= 0; --row) write_row(out, values.ptr<float>(row), values.cols);
    });
  }

  /// Middlebury .flo.
  void write_flo(const char* name, const cv::Mat& flow_px) {
    write(name, [&](std::ostream& out) {
      out << "PIEH";
      for (const int32_t size : {flow_px.cols, flow_px.rows}) {
        out.write(reinterpret_cast<const char*>(&size), sizeof size);
      }
      for (int row = 0; row < flow_px.rows; ++row) write_row(out, flow_px.ptr<float>(row), 2 * flow_px.cols);
    });
  }

  void write(const std::string& name, const std::function<void(std::ostream&)>& content) {
    files_.push_back(folder_ + "/" + name);
    slam::write_file_atomically(files_.back(), content);
  }

  const std::vector<std::string>& files() const { return files_; }

 private:
  static void write_row(std::ostream& out, const float* values, int count) {
    out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(sizeof(float)) * count);
  }

  std::string folder_;
  std::vector<std::string> files_;
};

/// Exact images of the cameras of one rig, as the core is told of it.
class TruthCamera {
 public:
  TruthCamera(const sim::World& world, const slam::StereoRig& rig)
      : world_(world),
        rig_(rig),
        renderer_(world, rig.width_px, rig.height_px, {.antialiasing = 0, .reflections = false}) {}

  sim::ImageTruth see(const mjData& state, const slam::Pose& T_world_camera) {
    sim::ImageTruth truth{
        rig_.fx_px, rig_.cx_px, rig_.cy_px, T_world_camera, {}, {}, sim::geom_poses(world_.model(), state)};
    renderer_.update_scene(state);
    renderer_.render_truth({rig_.fx_px, rig_.cx_px, rig_.cy_px, T_world_camera}, truth.depth_m, truth.geom);
    return truth;
  }

 private:
  const sim::World& world_;
  const slam::StereoRig rig_;
  sim::Renderer renderer_;
};

/// Ids from -1 as 16-bit grey values from 0.
cv::Mat ids_from_zero(const cv::Mat& ids) {
  cv::Mat grey;
  ids.convertTo(grey, CV_16U, 1, 1);
  return grey;
}

cv::Mat kitti_disparity(const cv::Mat& disparity_px) {
  cv::Mat grey;
  disparity_px.convertTo(grey, CV_16U, 256);
  return grey;
}

void write_labels(FrameFolder& out, const mjModel& model) {
  const auto name_of = [&](int kind, int id) {
    const char* const name = mj_id2name(&model, kind, id);
    return std::string(name == nullptr ? "" : name);
  };
  out.write("labels.csv", [&](std::ostream& text) {
    text << "image,value,name,body_value\n";
    for (int body = 0; body < model.nbody; ++body) {
      text << fmt::format("instances,{},{},\n", body + 1, name_of(mjOBJ_BODY, body));
    }
    for (int geom = 0; geom < model.ngeom; ++geom) {
      text << fmt::format("geoms,{},{},{}\n", geom + 1, name_of(mjOBJ_GEOM, geom),
                          model.geom_bodyid[geom] + 1);
    }
  });
}

void write_motion(FrameFolder& out, const sim::ImageTruth& now, const sim::ImageTruth& next) {
  sim::ImageMotion motion = image_motion(now, next);
  cv::patchNaNs(motion.flow_px, kUnknownFlow);
  out.write_flo("flow.flo", motion.flow_px);
  out.write_png("visible_next.png", motion.visible);
  out.write_png("moving.png", motion.moving);
}

}  // namespace

std::vector<std::string> export_frame(const sim::Scenario& asked, int64_t frame, const std::string& folder) {
  const sim::Scenario scenario = sim::realized(asked);
  if (scenario.plan.feedback == sim::Feedback::kSlam) {
    throw InputError(Problem{scenario.file, 0, "plan.feedback", "slam",
                             "a plan whose path does not depend on the SLAM: --set plan.feedback=plan"});
  }
  const sim::HeadModel head = sim::carried_head(scenario);
  std::future<sim::RendererInfo> renderer = renderer_from_behind(scenario.render.settings());
  const sim::World world = sim::World::load(scenario, sim::Looks::kNone);
  SimulatedSource source(scenario, world, head, renderer.get(), std::nullopt);
  if (frame < 0 || frame >= *source.size()) {
    throw InputError(Problem{"", 0, "frame", fmt::format("{}", frame),
                             fmt::format("a pair of the run, 0 to {}", *source.size() - 1)});
  }
  const SimulatedSource::LonePair lone = source.alone(frame);
  FrameFolder out(folder);
  out.write_png("left.png", lone.frame.left);
  out.write_png("right.png", lone.frame.right);

  const slam::StereoRig& rig = source.rig();
  TruthCamera camera(world, rig);
  const sim::ImageTruth left = camera.see(*lone.seen.state, lone.T_world_left);
  const sim::ImageTruth right =
      camera.see(*lone.seen.state, lone.T_world_left * Eigen::Translation3d(rig.baseline_m, 0, 0));
  out.write_pfm("depth.pfm", left.depth_m);
  out.write_png("disparity.png", kitti_disparity(true_disparity_px(left, rig.baseline_m)));
  out.write_png("geoms.png", ids_from_zero(left.geom));
  out.write_png("instances.png", ids_from_zero(instances(left, world.model())));
  write_labels(out, world.model());
  out.write_png("visible_right.png", image_motion(left, right).visible);
  if (lone.next) write_motion(out, left, camera.see(*lone.next->state, lone.T_world_next));
  return out.files();
}

}  // namespace groundloop::bench
