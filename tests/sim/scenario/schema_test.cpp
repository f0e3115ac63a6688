#include "sim/scenario/schema.h"

#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sim/scenario/metric_names.h"

namespace groundloop::sim {
namespace {

using ::testing::Contains;
using Json = nlohmann::json;

const Json& schema() {
  static const Json parsed = Json::parse(scenario_schema());
  return parsed;
}

TEST(Schema, CommittedFileIsUpToDate) {
  std::ifstream in("scenarios/schema.json");
  std::stringstream committed;
  committed << in.rdbuf();
  EXPECT_EQ(committed.str(), scenario_schema()) << "regenerate: scenario_schema > scenarios/schema.json";
}

TEST(Schema, SaysWhatTheStructsSay) {
  EXPECT_EQ(schema()["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema()["additionalProperties"], false);
  EXPECT_THAT(schema()["required"], Contains("plan"));

  const Json& plan = schema()["properties"]["plan"]["properties"];
  EXPECT_EQ(plan["speed_mps"]["maximum"], 1.2);
  EXPECT_EQ(plan["feedback"]["enum"], Json({"plan", "odometry", "slam", "truth"}));
  EXPECT_EQ(plan["feedback"]["default"], "plan");
  const Json& segment = plan["segments"]["items"];
  EXPECT_EQ(segment["maxProperties"], 1);
  EXPECT_EQ(segment["properties"]["arc"]["required"], Json({"radius_m", "angle_deg"}));
  EXPECT_EQ(schema()["properties"]["seed"]["minimum"], 0);
}

TEST(Schema, KnowsEveryMetric) {
  const Json& expect = schema()["properties"]["expect"]["properties"];
  for (const char* name : kMetricNames) EXPECT_TRUE(expect.contains(name)) << name;
  EXPECT_EQ(expect.size(), kMetricNames.size() + 1) << "the metrics and `outcome`";
}

}  // namespace
}  // namespace groundloop::sim
