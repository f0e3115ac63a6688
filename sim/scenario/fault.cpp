#include "sim/scenario/fault.h"

#include <limits>
#include <vector>

namespace groundloop::sim {
namespace {

/// Archive that notes which of the kinds are set.
struct KindList {
  std::vector<std::string> all, set;

  template <class T>
  void operator()(const char* key, std::optional<T>& kind, const Field&) {
    all.emplace_back(key);
    if (kind) set.emplace_back(key);
  }
};

KindList kinds_of(Fault fault) {
  KindList kinds;
  fault.visit_kinds(kinds);
  return kinds;
}

}  // namespace

void Fault::check(ConfigReader& reader) const {
  const KindList kinds = kinds_of(*this);
  if (kinds.set.size() != 1) {
    std::string choice;
    for (const std::string& kind : kinds.all) choice += (choice.empty() ? "" : ", ") + kind;
    reader.problem("", "at_s, for_s and exactly one of: " + choice);
  }
  if (kidnap && for_s) reader.problem("for_s", "no for_s: a kidnapping is over at once");
}

double Fault::end_s() const {
  if (kidnap) return at_s;
  return for_s ? at_s + *for_s : std::numeric_limits<double>::infinity();
}

std::string Fault::kind() const {
  const KindList kinds = kinds_of(*this);
  return kinds.set.empty() ? "" : kinds.set.front();
}

}  // namespace groundloop::sim
