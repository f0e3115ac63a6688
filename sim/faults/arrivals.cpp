#include "sim/faults/arrivals.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "slam/types/counter_random.h"

namespace groundloop::sim {
namespace {

constexpr uint64_t kStream = 0x61727269'76616c73;  // "arrivals"

double seconds(int64_t stamp_ns) { return static_cast<double>(stamp_ns) * 1e-9; }

/// Decides for one exposure after the other.
class Transport {
 public:
  Transport(const std::vector<Fault>& faults, uint64_t seed, int64_t period_ns)
      : faults_(faults), seed_(seed), period_ns_(period_ns) {}

  std::optional<Arrival> next(int64_t exposure) {
    const std::optional<int64_t> images_of = struck(exposure, &Fault::drop) ? std::nullopt : taken(exposure);
    if (!images_of) return std::nullopt;
    last_images_of_ = images_of;
    return Arrival{exposure, *images_of, struck(exposure, &Fault::swap)};
  }

 private:
  /// Whose images are taken from the wire at the time of this exposure.
  std::optional<int64_t> taken(int64_t exposure) const {
    if (struck(exposure, &Fault::duplicate)) return last_images_of_;
    int64_t images_of = exposure;
    for (const Fault& fault : faults_) {
      if (!fault.late || !fault.active(time_s(exposure))) continue;
      const int64_t behind = exposure - fault.late->pairs;
      if (!fault.active(time_s(behind))) return std::nullopt;  // still under way
      images_of = std::min(images_of, behind);
    }
    return images_of;
  }

  bool struck(int64_t exposure, const std::optional<PairFault> Fault::*kind) const {
    for (size_t i = 0; i < faults_.size(); ++i) {
      const auto& fault = faults_[i].*kind;
      if (!fault || !faults_[i].active(time_s(exposure))) continue;
      const uint64_t bits = random_bits(seed_, kStream + i, static_cast<uint64_t>(exposure));
      if (static_cast<double>(bits >> 11) * 0x1p-53 < fault->probability) return true;
    }
    return false;
  }

  double time_s(int64_t exposure) const { return seconds(exposure * period_ns_); }

  const std::vector<Fault>& faults_;
  uint64_t seed_;
  int64_t period_ns_;
  std::optional<int64_t> last_images_of_;
};

}  // namespace

std::vector<Arrival> arrivals(const std::vector<Fault>& faults, uint64_t seed, int64_t exposures,
                              int64_t period_ns) {
  std::vector<Arrival> all;
  all.reserve(static_cast<size_t>(exposures));
  Transport transport(faults, seed, period_ns);
  for (int64_t exposure = 0; exposure < exposures; ++exposure) {
    if (const auto arrival = transport.next(exposure)) all.push_back(*arrival);
  }
  return all;
}

std::string fault_label(const std::vector<Fault>& faults, int64_t after_ns, int64_t stamp_ns) {
  std::vector<std::string> kinds;
  for (const Fault& fault : faults) {
    if (fault.at_s > seconds(stamp_ns)) continue;
    // a kidnapping is over at once, and shows in the first pair from then on
    const bool over = fault.kidnap ? fault.at_s <= seconds(after_ns) : fault.end_s() <= seconds(after_ns);
    if (over) continue;
    const std::string kind = fault.kind();
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
  }
  std::string label;
  for (const std::string& kind : kinds) label += (label.empty() ? "" : "+") + kind;
  return label;
}

}  // namespace groundloop::sim
