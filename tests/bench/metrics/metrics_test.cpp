#include "bench/metrics/metrics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace groundloop::bench {
namespace {

TEST(MetricsJson, IsFlatSortedAndExact) {
  const Metrics metrics = {{"trajectory.ate_rmse_m", 0.1 + 0.2}, {"map.f1", 1}};
  EXPECT_EQ(to_json(metrics), "{\n  \"map.f1\": 1.0,\n  \"trajectory.ate_rmse_m\": 0.30000000000000004\n}\n");
  EXPECT_EQ(nlohmann::json::parse(to_json(metrics)).get<Metrics>(), metrics);
}

}  // namespace
}  // namespace groundloop::bench
