// The frame path allocates nothing of its own between key frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <opencv2/core/utility.hpp>

#include "slam/pipeline/pipeline.h"
#include "slam/tracking/rotation_alignment.h"
#include "tests/slam/pipeline/box_room.h"

#if defined(__GLIBC__) && !defined(GROUNDLOOP_SANITIZED)

namespace {
thread_local int64_t allocations = 0;  // of this thread: what is done in the background does not count
}

// Eigen and OpenCV allocate by malloc, the standard library by operator new, which calls malloc.
extern "C" void* __libc_malloc(size_t size);
extern "C" void* malloc(size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace groundloop::slam {
namespace {

template <class Work>
int64_t allocations_of(Work work) {
  const int64_t before = allocations;
  work();
  return allocations - before;
}

TEST(Pipeline, AllocatesNothingAFrameBesideTheBuffersOfOpenCvsFilters) {
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const BoxRoom room;
  Pipeline core(room.rig(), {});
  ImagePyramid left, right;
  RotationAlignment rotation(room.rig());
  FrameResult result;
  int64_t least = INT64_MAX, filters = 0;
  for (int64_t i = 0; i < 30; ++i) {
    const double step = 0.1 * static_cast<double>(i);
    const StereoFrame frame = room.frame(i, step, step - 0.1);
    const int64_t spent = allocations_of([&] { core.process(frame, result); });
    filters = allocations_of([&] {
      left.build(frame.left, core.options().klt.levels);
      right.build(frame.right, core.options().klt.levels);
      rotation.remember(left);
    });
    // Growth of the path is rare; the least of some frames has none.
    if (i > 15 && !result.is_key_frame) least = std::min(least, spent);
  }
  cv::setNumThreads(threads);
  EXPECT_EQ(least, filters);
}

}  // namespace
}  // namespace groundloop::slam

#endif
