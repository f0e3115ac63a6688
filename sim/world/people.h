#pragma once

#include <string>

#include "sim/world/mjcf.h"

namespace groundloop::sim {

/// Reads an MJCF file of a person: `<asset>` and one body of the `<worldbody>`, with geoms only, whose frame
/// is on the floor between the feet (x forward, z up). Bodies named left_leg, right_leg, left_arm and
/// right_arm, if there are any, swing about their own y axes. Every name gets the person's before it
/// ("anna/left_leg"), so that a file can be used more than once. Nothing collides with a person: geoms get no
/// contacts.
/// @throws InputError naming file, line and element
MjcfElement read_person(const std::string& file, const std::string& name);

}  // namespace groundloop::sim
