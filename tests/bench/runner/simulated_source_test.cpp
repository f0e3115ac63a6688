#include "bench/runner/simulated_source.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "sim/simulation/carried_head.h"

namespace groundloop::bench {
namespace {

bool same(const slam::StereoFrame& a, const slam::StereoFrame& b) {
  return a.index == b.index && a.stamp_ns == b.stamp_ns && cv::norm(a.left, b.left, cv::NORM_INF) == 0 &&
         cv::norm(a.right, b.right, cv::NORM_INF) == 0;
}

class SimulatedSourceTest : public testing::Test {
 protected:
  explicit SimulatedSourceTest(const std::string& head = "models/heads/sth_mdcs.yaml")
      : scenario_(sim::load_scenario(
            "scenarios/smoke.yaml",
            {{"render.profile", "fast"}, {"head.model", std::filesystem::absolute(head)}})),
        head_(sim::carried_head(scenario_)),
        world_(sim::World::load(scenario_)),
        renderer_(renderer_from_behind(scenario_.render.settings()).get()) {}

  std::vector<slam::StereoFrame> pairs(SimulatedSource& source) const {
    std::vector<slam::StereoFrame> all;
    while (auto frame = source.next()) all.push_back(std::move(*frame));
    return all;
  }

  sim::Scenario scenario_;
  sim::HeadModel head_;
  const sim::World world_;
  const sim::RendererInfo renderer_;
};

TEST_F(SimulatedSourceTest, TwoMakersGiveTheSameAsOneAndAsAPairAlone) {
  SimulatedSource few(scenario_, world_, head_, renderer_, 6), many(scenario_, world_, head_, renderer_, 32);
  const std::vector<slam::StereoFrame> by_one = pairs(few), by_two = pairs(many);
  ASSERT_EQ(by_one.size(), 6U);
  ASSERT_EQ(by_two.size(), 32U);
  for (size_t i = 0; i < by_one.size(); ++i) EXPECT_TRUE(same(by_one[i], by_two[i])) << i;

  for (const int64_t index : {0, 17, 31}) {
    SimulatedSource source(scenario_, world_, head_, renderer_, std::nullopt);
    const SimulatedSource::LonePair lone = source.alone(index);
    EXPECT_TRUE(same(lone.frame, by_two[static_cast<size_t>(index)])) << index;
    EXPECT_EQ(source.rendered(), 1);
    EXPECT_EQ(lone.T_world_left.matrix(), many.truth(index).T_world_seen.matrix());
    ASSERT_TRUE(lone.next);
    EXPECT_EQ(lone.next->index, index + 1);
  }
}

TEST_F(SimulatedSourceTest, TheSecondRunRendersNothing) {
  const auto folder = std::filesystem::temp_directory_path() / "simulated_source_cache";
  std::filesystem::remove_all(folder);
  sim::PairCache cache(folder);
  SimulatedSource first(scenario_, world_, head_, renderer_, 5, &cache);
  const std::vector<slam::StereoFrame> rendered = pairs(first);
  EXPECT_EQ(first.rendered(), 5);
  EXPECT_EQ(cache.stored(), 5);

  SimulatedSource second(scenario_, world_, head_, renderer_, 5, &cache);
  const std::vector<slam::StereoFrame> found = pairs(second);
  EXPECT_EQ(second.rendered(), 0);
  for (size_t i = 0; i < rendered.size(); ++i) EXPECT_TRUE(same(rendered[i], found[i])) << i;
}

TEST_F(SimulatedSourceTest, WhateverChangesAPixelIsRenderedAgain) {
  const auto folder = std::filesystem::temp_directory_path() / "simulated_source_changes";
  std::filesystem::remove_all(folder);
  sim::PairCache cache(folder);
  /// Pairs rendered of two with something changed.
  const auto rendered = [&](const std::function<void(sim::Scenario&, sim::HeadModel&)>& change) {
    sim::Scenario scenario = scenario_;
    sim::HeadModel head = head_;
    change(scenario, head);
    SimulatedSource source(scenario, world_, head, renderer_, 2, &cache);
    pairs(source);
    return source.rendered();
  };
  EXPECT_EQ(rendered([](auto&, auto&) {}), 2);
  EXPECT_EQ(rendered([](auto& s, auto&) { s.slam.preset = "default"; }), 0);
  EXPECT_EQ(rendered([](auto& s, auto&) { s.seed = 2; }), 2);
  EXPECT_EQ(rendered([](auto& s, auto&) { s.render.reflections = true; }), 2);
  EXPECT_EQ(rendered([](auto&, auto& h) { h.noise.read_grey += 0.1; }), 2);
  EXPECT_EQ(rendered([](auto&, auto& h) { h.baseline_m += 0.001; }), 2);
  EXPECT_EQ(rendered([](auto& s, auto&) {
              sim::LightChange dimmed;
              dimmed.factor = 0.5;
              s.lights.push_back(dimmed);
            }),
            2);
  // a fault that is over, or yet to come, changes nothing; one in force does
  const auto flash = [](double at_s) {
    return [at_s](sim::Scenario& s, sim::HeadModel&) {
      sim::Fault fault;
      fault.at_s = at_s;
      fault.flash.emplace();
      s.faults.push_back(fault);
    };
  };
  EXPECT_EQ(rendered(flash(3)), 0);
  EXPECT_EQ(rendered(flash(0.1)), 1);
}

TEST_F(SimulatedSourceTest, TexturesAreKnownByWhatTheirFilesHold) {
  const auto folder = std::filesystem::temp_directory_path() / "simulated_source_textures";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "world.xml") << R"(<mujoco>
    <asset>
      <texture name="paper" type="2d" file="paper.png"/>
      <material name="wall" texture="paper"/>
    </asset>
    <worldbody>
      <geom type="plane" size="5 5 1"/>
      <geom name="wall" type="box" size="0.1 2 1" pos="3 0 1" material="wall"/>
    </worldbody>
  </mujoco>)";
  sim::Scenario scenario = scenario_;
  scenario.world.file = (folder / "world.xml").string();
  const auto paint = [&](uint8_t grey) {
    cv::imwrite((folder / "paper.png").string(), cv::Mat(16, 16, CV_8UC3, cv::Scalar::all(grey)));
  };
  sim::PairCache cache(folder / "cache");
  const auto rendered = [&] {
    const sim::World world = sim::World::load(scenario, sim::Looks::kNone);
    SimulatedSource source(scenario, world, head_, renderer_, 1, &cache);
    pairs(source);
    return source.rendered();
  };
  paint(40);
  EXPECT_EQ(rendered(), 1);
  EXPECT_EQ(rendered(), 0);
  paint(41);
  EXPECT_EQ(rendered(), 1);
  paint(40);
  EXPECT_EQ(rendered(), 0);
}

/// A head that sets its exposure by what it saw.
class RawSourceTest : public SimulatedSourceTest {
 protected:
  RawSourceTest() : SimulatedSourceTest("models/heads/sth_mdcs_raw.yaml") {
    head_.raw->exposure.sub_frames = 1;
    head_.raw->exposure.automatic.emplace();
  }
};

TEST_F(RawSourceTest, AutomaticExposureGoesOnFromFoundPairs) {
  const auto folder = std::filesystem::temp_directory_path() / "simulated_source_raw";
  std::filesystem::remove_all(folder);
  sim::PairCache cache(folder);
  SimulatedSource none(scenario_, world_, head_, renderer_, 5);
  const std::vector<slam::StereoFrame> wanted = pairs(none);
  SimulatedSource first(scenario_, world_, head_, renderer_, 3, &cache);
  pairs(first);
  SimulatedSource second(scenario_, world_, head_, renderer_, 5, &cache);
  const std::vector<slam::StereoFrame> half_found = pairs(second);
  EXPECT_EQ(second.rendered(), 2);
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_TRUE(same(wanted[i], half_found[i])) << i;
}

}  // namespace
}  // namespace groundloop::bench
