#pragma once

#include <atomic>

namespace groundloop::bench {

/// From the first call on, Ctrl-C (SIGINT) and SIGTERM set the returned flag, once; a second one ends the
/// program at once, as without this.
const std::atomic<bool>& stop_on_interrupt();

}  // namespace groundloop::bench
