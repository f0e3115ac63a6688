#pragma once

#include "sim/robot/planned_path.h"
#include "sim/scenario/scenario.h"
#include "sim/truth/truth_world.h"

namespace groundloop::sim {

inline constexpr double kPathClearance_m =
    0.03;  ///< kept from everything; covers the way between two samples

/// Follows the planned path in steps of at most 5 cm and 3 degrees, from where kidnappings put the robot,
/// too.
/// @throws InputError with the first place in every segment where the robot would touch something: file and
/// line of the segment, its number, the place and the name of the geom; likewise with every kidnapping to
/// such a place, and every fault that begins after the plan's end
void check_path(const Scenario& scenario, const PlannedPath& path, const TruthWorld& truth);

/// People must keep off furniture, and 0.5 m away from the robot as planned (nothing collides with them).
/// @throws InputError naming the person, the place and the time
void check_people(const Scenario& scenario, const PlannedPath& path, const TruthWorld& truth);

}  // namespace groundloop::sim
