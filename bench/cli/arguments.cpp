#include "bench/cli/arguments.h"

#include <charconv>

namespace groundloop::bench {
namespace {

std::optional<uint64_t> whole_number(std::string_view text) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

SeedRange parse_seeds(const std::string& text) {
  const size_t dots = text.find("..");
  const auto first = whole_number(text.substr(0, dots));
  const auto last = dots == std::string::npos ? first : whole_number(text.substr(dots + 2));
  if (!first || !last || *first > *last) {
    throw InputError(Problem{"", 0, "--seed", text, "a whole number, or A..B with A at most B"});
  }
  return {*first, *last};
}

OracleStages parse_stages(const std::vector<std::string>& names) {
  OracleStages stages;
  for (const std::string& name : names) {
    bool found = false;
    std::string known;
    for (const auto& [stage, stage_name] : EnumNames<slam::OracleStage>::names) {
      known += (known.empty() ? "" : ", ") + std::string(stage_name);
      if (name != stage_name) continue;
      stages.insert(stage);
      found = true;
    }
    if (!found) throw InputError(Problem{"", 0, "--oracle", name, "one of: " + known});
  }
  return stages;
}

sim::Override parse_override(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError(Problem{"", 0, "--set", text, "key=value, such as slam.preset=paper"});
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<sim::Override> overrides_of(const std::vector<std::string>& texts) {
  std::vector<sim::Override> overrides;
  overrides.reserve(texts.size());
  for (const std::string& text : texts) overrides.push_back(parse_override(text));
  return overrides;
}

CLI::Option* add_repeatable(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                            const std::string& help) {
  // Any number of times, but one value each time: what follows it may be the scenario file.
  return command.add_option(name, values, help)->expected(-1)->allow_extra_args(false);
}

CLI::Option* add_set(CLI::App& command, std::vector<std::string>& set, const std::string& help) {
  return add_repeatable(command, "--set", set, help)->type_name("KEY=VALUE");
}

}  // namespace groundloop::bench
