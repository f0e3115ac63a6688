#include "sim/simulation/carried_head.h"

namespace groundloop::sim {

HeadModel carried_head(const Scenario& scenario) {
  HeadModel head = load_head(scenario.head.model);
  const Plan& plan = scenario.plan;
  if (!plan.is_for_arm()) return head;
  head.baseline_m *= scenario.scale;
  head.mount = {};
  head.mount.z_m = scenario.scale * (plan.path ? plan.path->z_m : plan.poses.front().z_m);
  head.mount.tilt_deg = plan.path ? plan.path->tilt_deg : plan.poses.front().tilt_deg;
  return head;
}

}  // namespace groundloop::sim
