#include "sim/scenario/scenery.h"

#include <algorithm>
#include <cctype>

namespace groundloop::sim {

void Person::check(ConfigReader& reader) const {
  const auto usable = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  };
  if (reader.has("name") && (name.empty() || !std::all_of(name.begin(), name.end(), usable))) {
    reader.problem("name", "letters, digits, dashes and underscores");
  }
  if (reader.has("way") && way.empty()) reader.problem("way", "at least one point");
}

}  // namespace groundloop::sim
