#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/scenario/fault.h"

namespace groundloop::sim {

/// What arrives at the core in the place of one exposure.
struct Arrival {
  int64_t exposure = 0;   ///< whose stamp it carries, and up to which planned motion is told
  int64_t images_of = 0;  ///< whose images they are; not after `exposure`
  bool swapped = false;   ///< left and right have changed places
};

/// What becomes of the pairs on their way from the head to the core: one entry for each pair that arrives, in
/// order. Exposure k is at k times the period.
///
/// drop       the pair is lost; the next one carries the next stamp.
/// duplicate  the pair is lost, and the images of the one before arrive again with its stamp (a frame grabber
///            that hands out its last buffer). Before the first pair there is nothing to hand out.
/// late       a pair arrives `pairs` periods after its exposure and is stamped on arrival. For so many
///            periods nothing arrives at first; at the end those still under way are overtaken and lost.
/// swap       left and right have changed places.
///
/// Every decision depends on (seed, fault, exposure) alone.
std::vector<Arrival> arrivals(const std::vector<Fault>& faults, uint64_t seed, int64_t exposures,
                              int64_t period_ns);

/// Kinds of the faults that were active at any time after one stamp and up to another, as "drop+blur"; empty
/// when there was none. Each kind once, in the order of `faults`.
std::string fault_label(const std::vector<Fault>& faults, int64_t after_ns, int64_t stamp_ns);

}  // namespace groundloop::sim
