#include "bench/runner/priority.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

namespace groundloop::bench {
namespace {

/// A tenth of the share of a thread of ordinary priority: with two processors the core has one when it asks
/// for it, and machines that also do other things still render.
constexpr int kNiceness = 10;

}  // namespace

void stand_back() {
  // Linux keeps a niceness of its own for every thread. A refusal (a thread that is nicer already) is no
  // matter.
  const auto thread = static_cast<id_t>(gettid());
  setpriority(PRIO_PROCESS, thread, std::max(getpriority(PRIO_PROCESS, thread), kNiceness));
}

}  // namespace groundloop::bench
