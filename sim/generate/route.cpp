#include "sim/generate/route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>

#include "sim/robot/pose2.h"
#include "sim/world/generate/dice.h"

namespace groundloop::sim {
namespace {

constexpr int kAttempts = 60, kMostAttempts = 400;  ///< to find a good one; to find any
constexpr double kGoodEnough = 0.25;  ///< misfit of a lap
constexpr double kLookEvery_m = 0.5, kLookEvery_rad = 15 * std::numbers::pi / 180;
constexpr double kAgain = 0.7;  ///< what a place costs more each time it is visited again
constexpr double kLegLength_m = 5;

double deg(double rad) { return rad * 180 / std::numbers::pi; }

/// Ways in the order in which they are driven; closed: the last leads into the first.
struct Tour {
  std::vector<int> ways;
  bool closed = false;
  double length_m = 0;
};

class Tours {
 public:
  Tours(Roadmap& map, const TextureSight& sight, const PlanRecipe& recipe, double lap_m)
      : map_(map), sight_(sight), recipe_(recipe), lap_m_(lap_m) {}

  /// A tour drawn from the dice; empty when the dice led nowhere.
  Tour draw(Dice dice);
  /// Looks round along the tour; what shows too little is not driven again.
  bool shows_enough(const Tour& tour);
  const Turn& turn(int from, int to) const { return *find_turn(from, to); }
  /// How far a tour is from a round lap of the wanted length, 0 to infinity; 0 for a way that is not closed.
  double misfit(const Tour& tour) const;

 private:
  Way& way(int index) const { return map_.ways[static_cast<size_t>(index)]; }
  Turn* find_turn(int from, int to) const;
  Tour draw_lap(Dice& dice);
  Tour draw_open(Dice& dice);
  int any_way(Dice& dice, int point) const;
  bool extend(Tour& tour, const std::function<bool(const Way&, int)>& reached);
  bool shows_enough(Pose2 from, double length_m, double turn_rad) const;

  Roadmap& map_;
  const TextureSight& sight_;
  const PlanRecipe& recipe_;
  double lap_m_;
  std::vector<int> visits_;  ///< by point
};

Turn* Tours::find_turn(int from, int to) const {
  for (Turn& turn : way(from).turns) {
    if (turn.to == to) return &turn;
  }
  return nullptr;
}

int Tours::any_way(Dice& dice, int point) const {
  const std::vector<int>& ways = map_.ways_from[static_cast<size_t>(point)];
  return ways.empty() ? -1 : dice.pick(ways);
}

/// Dijkstra from the tour's last way; appends the ways after it up to the first that is `reached`.
bool Tours::extend(Tour& tour, const std::function<bool(const Way&, int)>& reached) {
  std::vector<double> cost(map_.ways.size(), std::numeric_limits<double>::infinity());
  std::vector<int> before(map_.ways.size(), -1);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const int start = tour.ways.back();
  open.emplace(0, start);
  int end = -1;
  bool first = true;
  while (!open.empty() && end < 0) {
    const auto [so_far, at] = open.top();
    open.pop();
    if (!first && so_far > cost[static_cast<size_t>(at)]) continue;
    if (!first && reached(way(at), at)) end = at;
    first = false;
    for (const Turn& turn : way(at).turns) {
      const Way& next = way(turn.to);
      if (turn.sight == Sight::kTooLittle || next.sight == Sight::kTooLittle) continue;
      const double again = 1 + kAgain * visits_[static_cast<size_t>(next.to)];
      const double total = so_far + turn.cost + next.cost * again;
      if (total >= cost[static_cast<size_t>(turn.to)]) continue;
      cost[static_cast<size_t>(turn.to)] = total;
      before[static_cast<size_t>(turn.to)] = at;
      open.emplace(total, turn.to);
    }
  }
  if (end < 0) return false;
  std::vector<int> leg = {end};
  while (before[static_cast<size_t>(leg.back())] != start) leg.push_back(before[static_cast<size_t>(leg.back())]);
  for (auto it = leg.rbegin(); it != leg.rend(); ++it) {
    const Turn& corner = turn(tour.ways.back(), *it);
    tour.length_m += way(*it).length_m + corner.radius_m * std::abs(corner.angle_rad) - 2 * corner.tangent_m;
    tour.ways.push_back(*it);
    ++visits_[static_cast<size_t>(way(*it).to)];
  }
  return true;
}

/// Round a few places that lie about as far from each other as the length asks for.
Tour Tours::draw_lap(Dice& dice) {
  const auto points = static_cast<int>(map_.points.size());
  const int anchor = dice.integer(0, points - 1);
  const double reach_m = lap_m_ / 3 * dice.uniform(0.5, 1.3);
  std::vector<int> near;
  for (int p = 0; p < points; ++p) {
    const double far_m = (map_.points[static_cast<size_t>(p)] - map_.points[static_cast<size_t>(anchor)]).norm();
    if (far_m <= reach_m) near.push_back(p);
  }
  std::vector<int> places;
  const int most = std::clamp(static_cast<int>(lap_m_ / kLegLength_m), 2, 8);
  for (int i = dice.integer(2, most); i > 0; --i) places.push_back(dice.pick(near));
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const int p : places) middle += map_.points[static_cast<size_t>(p)] / static_cast<double>(places.size());
  const double turn = dice.chance(0.5) ? 1 : -1;
  std::sort(places.begin(), places.end(), [&](int a, int b) {
    const Eigen::Vector2d to_a = map_.points[static_cast<size_t>(a)] - middle;
    const Eigen::Vector2d to_b = map_.points[static_cast<size_t>(b)] - middle;
    return turn * std::atan2(to_a.y(), to_a.x()) < turn * std::atan2(to_b.y(), to_b.x());
  });

  Tour tour;
  const int first = any_way(dice, places.front());
  if (first < 0 || way(first).sight == Sight::kTooLittle) return {};
  tour.ways = {first};
  for (size_t i = 1; i < places.size(); ++i) {
    if (way(tour.ways.back()).to == places[i]) continue;
    if (!extend(tour, [&](const Way& w, int) { return w.to == places[i]; })) return {};
  }
  if (!extend(tour, [&](const Way&, int index) { return index == first; })) return {};
  tour.ways.pop_back();  // the first way again: its length is counted where it is closed
  tour.closed = true;
  return tour;
}

Tour Tours::draw_open(Dice& dice) {
  const auto points = static_cast<int>(map_.points.size());
  const int first = any_way(dice, dice.integer(0, points - 1));
  if (first < 0 || way(first).sight == Sight::kTooLittle) return {};
  Tour tour{{first}, false, way(first).length_m};
  // Longer by a metre: a turn at the end takes some of the last way.
  for (int leg = 0; tour.length_m < lap_m_ + 1; ++leg) {
    int least = dice.integer(0, points - 1);
    for (int other = 0; other < 3; ++other) {
      const int p = dice.integer(0, points - 1);
      if (visits_[static_cast<size_t>(p)] < visits_[static_cast<size_t>(least)]) least = p;
    }
    const bool went = way(tour.ways.back()).to != least && extend(tour, [&](const Way& w, int) { return w.to == least; });
    if (!went && leg > 50 + static_cast<int>(lap_m_)) return {};
  }
  return tour;
}

/// A circle has a mean distance from its middle of its length / 2 pi; a lap that winds or turns back, less.
double Tours::misfit(const Tour& tour) const {
  if (!tour.closed) return 0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  const auto n = static_cast<double>(tour.ways.size());
  for (const int w : tour.ways) middle += map_.points[static_cast<size_t>(way(w).to)] / n;
  double mean_m = 0;
  for (const int w : tour.ways) mean_m += (map_.points[static_cast<size_t>(way(w).to)] - middle).norm() / n;
  const double roundness = std::min(1.0, mean_m * 2 * std::numbers::pi / tour.length_m);
  return std::abs(tour.length_m / lap_m_ - 1) + (1 - roundness);
}

Tour Tours::draw(Dice dice) {
  visits_.assign(map_.points.size(), 0);
  return recipe_.laps > 0 ? draw_lap(dice) : draw_open(dice);
}

bool Tours::shows_enough(Pose2 from, double length_m, double turn_rad) const {
  const int steps = static_cast<int>(
      std::ceil(std::max({1.0, length_m / kLookEvery_m, std::abs(turn_rad) / kLookEvery_rad})));
  for (int i = 0; i <= steps; ++i) {
    const Pose2 at = driven(from, length_m * i / steps, turn_rad * i / steps);
    if (sight_.visible(at.x_m, at.y_m, at.yaw_rad) < recipe_.min_texture) return false;
  }
  return true;
}

bool Tours::shows_enough(const Tour& tour) {
  bool enough = true;
  const auto look = [&](Sight& known, const Pose2& from, double length_m, double turn_rad) {
    if (known == Sight::kUnknown) {
      known = shows_enough(from, length_m, turn_rad) ? Sight::kEnough : Sight::kTooLittle;
    }
    enough = enough && known == Sight::kEnough;
  };
  for (size_t i = 0; i < tour.ways.size(); ++i) {
    Way& w = way(tour.ways[i]);
    const Eigen::Vector2d& from = map_.points[static_cast<size_t>(w.from)];
    look(w.sight, {from.x(), from.y(), w.yaw_rad}, w.length_m, 0);
    if (i + 1 == tour.ways.size() && !tour.closed) break;
    Turn& corner = *find_turn(tour.ways[i], tour.ways[(i + 1) % tour.ways.size()]);
    const double before_m = w.length_m - corner.tangent_m;
    look(corner.sight, driven({from.x(), from.y(), w.yaw_rad}, before_m, 0),
         corner.radius_m * std::abs(corner.angle_rad), corner.angle_rad);
  }
  return enough;
}

// ---- from ways to segments

void add_straight(std::vector<Segment>& segments, double length_m) {
  if (length_m <= 0) return;
  if (!segments.empty() && segments.back().straight_m) {
    *segments.back().straight_m += length_m;
    return;
  }
  Segment segment;
  segment.straight_m = length_m;
  segments.push_back(segment);
}

void add_arc(std::vector<Segment>& segments, double radius_m, double angle_rad) {
  Segment segment;
  segment.arc = ArcSegment{radius_m, deg(angle_rad)};
  segments.push_back(segment);
}

StartPose start_on(const Roadmap& map, const Way& way, double along_m) {
  const Eigen::Vector2d& from = map.points[static_cast<size_t>(way.from)];
  const Pose2 at = driven({from.x(), from.y(), way.yaw_rad}, along_m, 0);
  return {at.x_m, at.y_m, deg(at.yaw_rad)};
}

/// Begins and ends in the middle of the first way.
Route closed_route(const Roadmap& map, const Tours& tours, const Tour& tour, int laps) {
  const size_t n = tour.ways.size();
  const auto way = [&](size_t i) -> const Way& { return map.ways[static_cast<size_t>(tour.ways[i % n])]; };
  const auto corner = [&](size_t i) -> const Turn& { return tours.turn(tour.ways[i % n], tour.ways[(i + 1) % n]); };
  const double in_m = corner(n - 1).tangent_m;
  const double half_m = (way(0).length_m - in_m - corner(0).tangent_m) / 2;
  Route route;
  route.start = start_on(map, way(0), in_m + half_m);
  add_straight(route.segments, half_m);
  for (size_t i = 0; i < n * static_cast<size_t>(laps); ++i) {
    const Turn& turn = corner(i);
    add_arc(route.segments, turn.radius_m, turn.angle_rad);
    const bool last = i + 1 == n * static_cast<size_t>(laps);
    add_straight(route.segments,
                 last ? half_m : way(i + 1).length_m - turn.tangent_m - corner(i + 1).tangent_m);
  }
  return route;
}

/// Begins at the first point and ends when the length is driven.
Route open_route(const Roadmap& map, const Tours& tours, const Tour& tour, double length_m) {
  Route route;
  route.start = start_on(map, map.ways[static_cast<size_t>(tour.ways.front())], 0);
  double left_m = length_m, taken_m = 0;
  for (size_t i = 0; i < tour.ways.size() && left_m > 0; ++i) {
    const Way& way = map.ways[static_cast<size_t>(tour.ways[i])];
    const Turn* turn = i + 1 < tour.ways.size() ? &tours.turn(tour.ways[i], tour.ways[i + 1]) : nullptr;
    const double straight_m = std::min(left_m, way.length_m - taken_m - (turn != nullptr ? turn->tangent_m : 0));
    add_straight(route.segments, straight_m);
    left_m -= straight_m;
    if (turn == nullptr || left_m <= 0) break;
    const double arc_m = turn->radius_m * std::abs(turn->angle_rad);
    add_arc(route.segments, turn->radius_m, turn->angle_rad * std::min(1.0, left_m / arc_m));
    left_m -= arc_m;
    taken_m = turn->tangent_m;
  }
  return route;
}

}  // namespace

Route make_route(const Scenario& scenario, const TruthWorld& truth, const TextureSight& sight) {
  const PlanRecipe& recipe = scenario.plan.generate.value();
  const uint64_t seed = recipe.seed.value();
  const FreeSpace space(truth, truth.robot_radius_m() + recipe.clearance_m);
  Roadmap map(space, recipe, seed);
  const double lap_m = recipe.length_m / std::max(1, recipe.laps);
  Tours tours(map, sight, recipe, lap_m);

  Tour best;
  double best_misfit = std::numeric_limits<double>::infinity();
  const auto attempts = [&] { return best.ways.empty() ? kMostAttempts : kAttempts; };
  for (int attempt = 0; attempt < attempts() && !map.ways.empty() && best_misfit > kGoodEnough; ++attempt) {
    const Tour tour = tours.draw(Dice(seed, 500 + static_cast<uint64_t>(attempt)));
    if (tour.ways.empty()) continue;
    const double misfit = tours.misfit(tour);
    if (misfit >= best_misfit || !tours.shows_enough(tour)) continue;
    best = tour;
    best_misfit = misfit;
  }
  if (best.ways.empty()) {
    throw InputError(Problem{scenario.file, 0, "plan.generate",
                             fmt::format("no way in {:.1f} m2 of free floor", space.area_m2()),
                             "a world with more room, or a smaller length_m, min_radius_m, clearance_m or "
                             "min_texture"});
  }
  return best.closed ? closed_route(map, tours, best, recipe.laps)
                     : open_route(map, tours, best, recipe.length_m);
}

}  // namespace groundloop::sim
