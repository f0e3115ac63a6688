#pragma once

#include <mujoco/mujoco.h>

namespace groundloop::sim {

/// Makes everything in a model `factor` times as large: lengths times factor, masses by factor^2, so that
/// moments of inertia stay and servos that turn a small arm turn a large one as fast. Light that fades with
/// distance fades by the same share. Tendons and skins are left as they are.
void scale_model(mjModel& model, double factor);

}  // namespace groundloop::sim
