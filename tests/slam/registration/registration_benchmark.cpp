#include <benchmark/benchmark.h>

#include "slam/registration/registration.h"
#include "slam/types/stereo_uncertainty.h"
#include "tests/slam/features/texture.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::slam {
namespace {

/// 300 points, a tenth of them false, from a prediction that is a little off.
void register_300_points(benchmark::State& state, RegistrationCost cost) {
  StereoRig rig = centred_rig(640, 480, 577, 0.088);
  const Pose T_from_to = se3_exp((Vector6d() << 0.01, 0, 0.1, 0, 0.03, 0).finished());
  std::vector<PointPair> pairs;
  for (uint64_t k = 0; k < 300; ++k) {
    const double z = 1.5 + 6 * uniform(1, 1, k);
    const Eigen::Vector3d p((uniform(1, 2, k) - 0.5) * z, (uniform(1, 3, k) - 0.5) * 0.8 * z, z);
    const Eigen::Vector3d noise =
        0.2 * Eigen::Vector3d(gaussian(1, 4, k), gaussian(1, 5, k), gaussian(1, 6, k));
    const double false_px = k % 10 == 0 ? 8 : 0;
    pairs.push_back({p, point_covariance(rig, rig.project(p), 0.2),
                     rig.project(T_from_to.inverse() * p) + noise + Eigen::Vector3d(false_px, 0, false_px)});
  }
  RegistrationOptions options;
  options.cost = cost;
  Registration registration(rig, options);
  RegistrationResult result;
  for (auto _ : state) registration.align(pairs, Pose::Identity(), 1, result);
  if (!result.usable) state.SkipWithError(result.message.c_str());
}
BENCHMARK_CAPTURE(register_300_points, scalar_quadratic, RegistrationCost::kScalarQuadratic)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(register_300_points, reprojection, RegistrationCost::kReprojection)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace groundloop::slam
