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
