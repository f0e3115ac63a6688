#pragma once

#include <string>

namespace groundloop::sim {

/// JSON schema (draft 2020-12) of a scenario file, made from the structs themselves; for editors.
/// scenarios/schema.json is its output, pretty-printed.
std::string scenario_schema();

}  // namespace groundloop::sim
