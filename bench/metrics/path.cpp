#include "bench/metrics/path.h"

namespace groundloop::bench {

std::vector<double> travelled(const slam::Trajectory& poses) {
  std::vector<double> path_m(poses.size(), 0.0);
  for (size_t i = 1; i < poses.size(); ++i) {
    path_m[i] = path_m[i - 1] + (poses[i].T.translation() - poses[i - 1].T.translation()).norm();
  }
  return path_m;
}

}  // namespace groundloop::bench
