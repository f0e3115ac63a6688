#pragma once

#include <cstdint>

#include "slam/types/frame_result.h"

namespace groundloop::slam {

/// FNV-1a hash over the bits of pose, status and features. Two runs that agree in it agree in everything that
/// the core carries on; the first frame that differs names where they part.
uint64_t state_hash(const FrameResult& result);

}  // namespace groundloop::slam
