// The adjustment allocates nothing once it has solved a problem of that size.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "slam/adjustment/window_adjustment.h"
#include "tests/slam/adjustment/synthetic_window.h"

#if defined(__GLIBC__) && !defined(GROUNDLOOP_SANITIZED)

namespace {
std::atomic<int64_t> allocations{0};
}

// Eigen allocates by malloc, the standard library by operator new, which calls malloc: this one counts both.
extern "C" void* __libc_malloc(size_t size);
extern "C" void* malloc(size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}

namespace groundloop::slam {
namespace {

TEST(WindowAdjustment, AllocatesNothingOnceWarm) {
  const StereoRig rig = pioneer_rig();
  AdjustmentOptions options;
  options.planar_height_sigma_m = 0.01;
  options.planar_tilt_sigma_deg = 0.5;
  std::vector<SyntheticWindow> windows;
  for (const int key_frames : {12, 5, 8, 12}) {
    windows.push_back(
        make_window(rig, {.key_frames = key_frames, .landmarks = 20 * key_frames, .outliers = 0.1}));
    windows.back().problem.motions.push_back(
        {0, 1, windows.back().T_odom_left[0].inverse() * windows.back().T_odom_left[1],
         Matrix6d::Identity()});
  }
  WindowAdjustment adjustment(rig, options);
  AdjustmentResult result;
  adjustment.solve(windows[0].problem, result);
  const int64_t before = allocations;
  ASSERT_GT(before, 0);
  for (const SyntheticWindow& window : windows) {
    adjustment.solve(window.problem, result);
    ASSERT_TRUE(result.usable) << result.message;
  }
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace groundloop::slam

#endif
