#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/runner/options.h"
#include "slam/types/config.h"

namespace groundloop::bench {

/// Adds an option whose value is one of an enum's names; the help shows them with the default.
template <class E>
CLI::Option* add_choice(CLI::App& command, const std::string& name, E& value, const std::string& help) {
  std::vector<std::string> names;
  std::string current;
  for (const auto& [candidate, text] : EnumNames<E>::names) {
    names.emplace_back(text);
    if (candidate == value) current = text;
  }
  const auto set = [&value](const std::string& given) {
    for (const auto& [candidate, text] : EnumNames<E>::names) {
      if (given == text) value = candidate;
    }
  };
  return command.add_option_function<std::string>(name, set, help)
      ->check(CLI::IsMember(names))
      ->default_str(current)
      ->type_name("NAME");
}

/// "7" or "3..12", both ends included.
/// @throws InputError
SeedRange parse_seeds(const std::string& text);

/// Names of stages, as "tracking"; none: an empty set.
/// @throws InputError
OracleStages parse_stages(const std::vector<std::string>& names);

/// "key=value"; the value may hold further equals signs.
/// @throws InputError
sim::Override parse_override(const std::string& text);
std::vector<sim::Override> overrides_of(const std::vector<std::string>& texts);

/// An option that may be given any number of times, with one value each time.
CLI::Option* add_repeatable(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                            const std::string& help);

/// The options `--cache DIR`, `--cache-gb N` and `--no-cache`.
/// @param choice  the user's default, and what is chosen; must outlive the parsing
void add_cache(CLI::App& command, CacheChoice& choice);

/// The option `--renderer NAME`: chooses the backend of this process.
void add_renderer(CLI::App& command);

/// The option `--set KEY=VALUE`, repeatable.
CLI::Option* add_set(CLI::App& command, std::vector<std::string>& set, const std::string& help);

}  // namespace groundloop::bench
