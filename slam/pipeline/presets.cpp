#include "slam/pipeline/options.h"

namespace groundloop::slam {
namespace {

/// The method of the paper, sections 2.1 to 2.4, with the stated choices of docs/paper-to-code.md.
SlamOptions paper() {
  SlamOptions options;
  options.tracking.hold_lost_frames = 0;
  options.registration.cost = RegistrationCost::kScalarQuadratic;
  options.registration.lorentz_scale = 1;
  options.mapping.fuse_layers = false;
  options.dense_map.step_px = 0;
  // Every registration adds its error to the path, and the scalar weights make it a large one: key frames are
  // fewer than with the whole covariance, and doubtful features are kept for the sake of numbers.
  options.key_frame.min_tracked_ratio = 0.45;
  options.klt.max_sigma_px = 0.3;
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
