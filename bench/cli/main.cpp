#include <malloc.h>

#include <opencv2/core/utility.hpp>

#include "bench/cli/cli.h"

int main(int argc, char** argv) {
  // The frame path has one core; the other is for rendering and for what the core does in the background.
  cv::setNumThreads(1);
  // Images come and go with every pair: their memory is kept, or every one of them is cleared by the kernel
  // anew.
  constexpr int kLargestKept_bytes = 1 << 25, kKept_bytes = 1 << 28;
  mallopt(M_MMAP_THRESHOLD, kLargestKept_bytes);
  mallopt(M_TRIM_THRESHOLD, kKept_bytes);
  return groundloop::bench::run_cli(argc, argv);
}
