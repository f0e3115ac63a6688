#include "bench/cli/arguments.h"

#include <fmt/format.h>

#include <charconv>

#include "sim/render/gl_context.h"

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

void add_cache(CLI::App& command, CacheChoice& choice) {
  choice.folder = sim::default_cache_folder();
  CLI::Option* const folder =
      command.add_option("--cache", choice.folder, "keep rendered pairs here, for runs to come")
          ->capture_default_str()
          ->type_name("DIR");
  const auto set_size = [&choice](double gigabytes) {
    choice.max_bytes = static_cast<uint64_t>(gigabytes * 1e9);
  };
  command
      .add_option_function<double>("--cache-gb", set_size, "drop pairs unused for longest beyond this size")
      ->check(CLI::Range(0.001, 1e6))
      ->default_str(fmt::format("{}", static_cast<double>(choice.max_bytes) * 1e-9))
      ->type_name("GB");
  command
      .add_flag_callback(
          "--no-cache", [&choice] { choice.folder.clear(); }, "render every pair")
      ->excludes(folder);
}

void add_renderer(CLI::App& command) {
  std::vector<std::string> names;
  for (const auto& [backend, name] : EnumNames<sim::Backend>::names) names.emplace_back(name);
  const auto choose = [](const std::string& given) {
    for (const auto& [backend, name] : EnumNames<sim::Backend>::names) {
      if (given == name) sim::choose_backend(backend);
    }
  };
  command.add_option_function<std::string>("--renderer", choose, "who draws; the pixels are the same")
      ->check(CLI::IsMember(names))
      ->default_str(names.front())
      ->type_name("NAME");
}

CLI::Option* add_set(CLI::App& command, std::vector<std::string>& set, const std::string& help) {
  return add_repeatable(command, "--set", set, help)->type_name("KEY=VALUE");
}

}  // namespace groundloop::bench
