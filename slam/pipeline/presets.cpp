#include "slam/pipeline/options.h"

namespace groundloop::slam {
namespace {

/// The method of the paper, sections 2.1 to 2.4, with the stated choices of docs/paper-to-code.md.
SlamOptions paper() {
  SlamOptions options;
  options.tracking.max_features = 400;
  options.tracking.planned_start_level = 1;
  options.tracking.hold_lost_s = 0;
  options.tracking.min_kept_ratio = 0;
  options.tracking.perspective = false;
  options.tracking.own_precision = false;
  options.klt.max_sigma_px = 0.3;
  options.registration.cost = RegistrationCost::kScalarQuadratic;
  options.registration.sigma_px = 0.2;
  options.stereo.epipolar_gate_px = 1;
  options.stereo.max_row_offset_px = 0;
  options.stereo.max_right_late_s = 0;
  options.mapping.fuse_layers = false;
  options.mapping.ends_deny_empty = false;
  options.mapping.layer_heights_m = {0.05, 0.5, 1.0, 1.5, 2.0};
  options.mapping.k_empty = 0.4;
  options.mapping.sigma_disparity_px = 0.25;
  options.mapping.sigma_max_m = 0.30;
  options.dense_map.step_px = 0;
  options.adjustment.key_frames = 0;
  options.loop.enabled = false;
  options.map_match.enabled = false;
  // Every registration adds its error to the path, and the scalar weights make it a large one: key frames are
  // fewer than with the whole covariance.
  options.key_frame.min_tracked_ratio = 0.45;
  return options;
}

}  // namespace

std::vector<std::string> preset_names() { return {"default", "paper"}; }

SlamOptions preset(const std::string& name) {
  if (name == "default") return SlamOptions{};
  if (name == "paper") return paper();
  throw InputError(Problem{"", 0, "slam.preset", name, "one of: default, paper"});
}

}  // namespace groundloop::slam
