#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "bench/runner/dressed_world.h"
#include "bench/runner/raw_images.h"
#include "sim/cache/pair_cache.h"
#include "sim/head/head.h"
#include "sim/render/renderer.h"
#include "sim/scenario/scenario.h"
#include "sim/simulation/simulation.h"
#include "sim/world/world.h"

namespace groundloop::bench {

/// What a run's pairs are made of; every maker of the run has the same.
struct PairIngredients {
  const sim::World& world;  ///< with or without textures
  DressedWorld& dressed;    ///< the same with them
  const sim::HeadModel& head;
  const sim::Scenario& scenario;
  RawImages* raw;             ///< null for an ideal head
  sim::PairCache* cache;      ///< null: every pair is rendered
  const sim::KeyBuilder run;  ///< run_key()
};

/// Makes the pair that the head delivers of an exposure, before the cable: rendered, spoilt by faults and
/// sensors; or found in the cache. A function of (run, exposure) alone, but for a raw head whose exposure is
/// automatic: that one needs its exposures in order, from one maker.
///
/// Its OpenGL context is made with the first pair that is rendered, and belongs to that thread.
class PairMaker {
 public:
  explicit PairMaker(const PairIngredients& of) : of_(of) {}

  struct Pair {
    cv::Mat left, right;
    std::optional<sim::ExposureSetting> setting;  ///< of a raw head's left camera
    bool rendered = false;                        ///< not found in the cache
    double made_ms = 0;
  };
  Pair make(const sim::Exposure& exposure);

  /// Whether pairs may be made by several makers in any order.
  static bool in_any_order(const sim::HeadModel& head);

 private:
  sim::ExposureSetting raw_setting(const sim::Exposure& exposure) const;
  sim::Renderer& renderer();
  void render(const sim::Exposure& exposure, Pair& pair);
  void render_ideal(const sim::Exposure& exposure, Pair& pair);

  const PairIngredients& of_;
  std::unique_ptr<sim::Renderer> renderer_;
};

}  // namespace groundloop::bench
