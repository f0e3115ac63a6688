// groundloop cache: the pairs kept from run to run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.h"
#include "bench/cli/commands.h"
#include "bench/verdict/verdict.h"
#include "sim/cache/pair_cache.h"

namespace groundloop::bench {
namespace {

int show(const std::string& folder, bool clear, bool json) {
  if (folder.empty()) {
    throw InputError(
        Problem{"", 0, "--cache", "", "a folder (GROUNDLOOP_CACHE is off, or there is no HOME)"});
  }
  sim::PairCache cache(folder);
  const sim::PairCache::Status before = cache.status();
  if (clear) cache.clear();
  const sim::PairCache::Status now = clear ? cache.status() : before;
  if (json) {
    const nlohmann::ordered_json answer = {{"folder", folder}, {"pairs", now.pairs}, {"bytes", now.bytes}};
    fmt::print("{}\n", answer.dump(2));
    return exit_code(Outcome::kPass);
  }
  if (clear) fmt::print("{}: {} pairs dropped\n", folder, before.pairs - now.pairs);
  fmt::print("{}: {} pairs, {:.2f} GB\n", folder, now.pairs, static_cast<double>(now.bytes) * 1e-9);
  return exit_code(Outcome::kPass);
}

}  // namespace

void add_cache_command(CLI::App& app, CommandAction& action) {
  CLI::App* command = app.add_subcommand("cache", "the rendered pairs kept from run to run");
  const auto folder = std::make_shared<std::string>(sim::default_cache_folder());
  const auto clear = std::make_shared<bool>(false);
  const auto json = std::make_shared<bool>(false);
  command->add_option("--cache", *folder, "another cache than the user's")
      ->capture_default_str()
      ->type_name("DIR");
  command->add_flag("--clear", *clear, "drop all of them");
  command->add_flag("--json", *json, "print JSON");
  command->callback([=, &action] { action = [=] { return show(*folder, *clear, *json); }; });
}

}  // namespace groundloop::bench
