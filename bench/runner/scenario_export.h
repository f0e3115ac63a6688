#pragma once

#include <string>
#include <vector>

#include "sim/scenario/scenario.h"

namespace groundloop::bench {

/// `groundloop preview --export`: writes a scenario with all that was drawn from its seeds, to be edited: NAME.yaml
/// and, when the world is generated, NAME.xml. Paths in both are absolute.
/// @return the files written
/// @throws InputError when the plan cannot be made, or a file not be written
std::vector<std::string> export_scenario(const sim::Scenario& scenario, const std::string& folder);

}  // namespace groundloop::bench
