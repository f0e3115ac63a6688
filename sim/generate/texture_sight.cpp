#include "sim/generate/texture_sight.h"

#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace groundloop::sim {
namespace {

constexpr double kContrast_grey = 4;  ///< about the noise of one 8-bit pixel, twice
constexpr double kNearest_m = 0.4, kFarthest_m = 10;
constexpr int kPatch_px = 16;
constexpr int kColumns = 10, kRows = 8;  ///< of the raster

/// Contrast of each material that has a picture, by its name.
std::map<std::string, double> contrast_of_materials(const MjcfElement& mjcf, PictureContrast& pictures) {
  std::map<std::string, double> of_texture, of_material;
  const auto in_assets = [&](const auto& visit) {
    for (const MjcfElement& section : mjcf.children) {
      if (section.tag != "asset") continue;
      for (const MjcfElement& asset : section.children) visit(asset);
    }
  };
  in_assets([&](const MjcfElement& asset) {
    const std::string file = asset.get("file", asset.get("fileright"));
    if (asset.tag == "texture" && !file.empty()) of_texture[asset.get("name")] = pictures.of_file(file);
  });
  in_assets([&](const MjcfElement& asset) {
    const auto texture = of_texture.find(asset.get("texture"));
    if (asset.tag == "material" && texture != of_texture.end()) of_material[asset.get("name")] = texture->second;
  });
  return of_material;
}

}  // namespace

double PictureContrast::of_file(const std::string& file) {
  const auto [known, is_new] = known_.try_emplace(file, 0);
  if (!is_new) return known->second;
  const cv::Mat grey = cv::imread(file, cv::IMREAD_GRAYSCALE);
  double sum = 0;
  int patches = 0;
  for (int y = 0; y + kPatch_px <= grey.rows; y += kPatch_px) {
    for (int x = 0; x + kPatch_px <= grey.cols; x += kPatch_px, ++patches) {
      cv::Scalar mean, deviation;
      cv::meanStdDev(grey(cv::Rect(x, y, kPatch_px, kPatch_px)), mean, deviation);
      sum += deviation[0];
    }
  }
  return known->second = patches > 0 ? sum / patches : 0;
}

TextureSight::TextureSight(const World& world, const MjcfElement& mjcf, const TruthWorld& truth,
                           const HeadModel& head, PictureContrast& pictures)
    : truth_(truth), rig_(head.rig()) {
  const std::map<std::string, double> contrast = contrast_of_materials(mjcf, pictures);
  const mjModel& model = world.model();
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const int material = model.geom_matid[geom];
    const char* name = material < 0 ? nullptr : mj_id2name(&model, mjOBJ_MATERIAL, material);
    const auto found = name == nullptr ? contrast.end() : contrast.find(name);
    contrasty_.push_back(found != contrast.end() && found->second >= kContrast_grey);
  }
}

double TextureSight::visible(double x_m, double y_m, double yaw_rad) const {
  slam::Pose T_world_body = slam::Pose::Identity();
  T_world_body.translation() << x_m, y_m, 0;
  T_world_body.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const slam::Pose T_world_left = T_world_body * rig_.T_body_left;
  int seen = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kColumns; ++col) {
      const double u_px = (col + 0.5) * rig_.width_px / kColumns, v_px = (row + 0.5) * rig_.height_px / kRows;
      const Eigen::Vector3d ray((u_px - rig_.cx_px) / rig_.fx_px, (v_px - rig_.cy_px) / rig_.fy_px, 1);
      const auto hit = truth_.cast(T_world_left.translation(), T_world_left.linear() * ray, kFarthest_m);
      if (hit && hit->distance_m >= kNearest_m && contrasty_[static_cast<size_t>(hit->geom)] != 0) ++seen;
    }
  }
  return static_cast<double>(seen) / (kRows * kColumns);
}

}  // namespace groundloop::sim
