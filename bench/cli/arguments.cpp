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

sim::Override parse_override(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError(Problem{"", 0, "--set", text, "key=value, such as slam.preset=paper"});
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace groundloop::bench
