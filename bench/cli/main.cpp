#include <opencv2/core/utility.hpp>

#include "bench/cli/cli.h"

int main(int argc, char** argv) {
  // The frame path has one core; the other is for rendering and for what the core does in the background.
  cv::setNumThreads(1);
  return groundloop::bench::run_cli(argc, argv);
}
