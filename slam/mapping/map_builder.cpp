#include "slam/mapping/map_builder.h"

#include <algorithm>

namespace groundloop::slam {
namespace {

constexpr size_t kLooksACall = 8;

}  // namespace

MapBuilder::MapBuilder(const StereoRig& rig, const FlogOptions& options, int looks_kept)
    : rig_(rig), options_(options), looks_kept_(looks_kept), current_{Mapper(rig, options), {}} {}

void MapBuilder::add(Look look, const std::vector<Pose>& T_map_place) {
  keep(std::move(look));
  draw(T_map_place, 1);
}

void MapBuilder::keep(Look look) {
  looks_.push_back(std::move(look));
  forget_oldest(looks_.back().place);
}

bool MapBuilder::draw(const std::vector<Pose>& T_map_place, size_t looks) {
  fill(current_, T_map_place, looks);
  if (!next_ && has_moved(T_map_place)) next_ = Grid{Mapper(rig_, options_), {}};
  if (next_) {
    fill(*next_, T_map_place, kLooksACall);
    if (next_->T_map_left.size() == looks_.size()) {
      current_ = std::move(*next_);
      next_.reset();
    }
  }
  return current_.T_map_left.size() == looks_.size();
}

void MapBuilder::complete(const std::vector<Pose>& T_map_place, bool by_two) {
  next_.reset();
  current_ = Grid{Mapper(rig_, options_), {}};
  if (!by_two) return fill(current_, T_map_place, looks_.size());
  std::vector<PosedObservations> seen;
  seen.reserve(looks_.size());
  for (const Look& look : looks_) {
    seen.push_back({T_map_place[look.place] * look.T_place_left, look.observations});
    current_.T_map_left.push_back(seen.back().T_map_left);
  }
  current_.mapper.add_by_two(seen);
}

/// What a forgotten look wrote stays in the grids until the next rebuild.
void MapBuilder::forget_oldest(int place) {
  const auto of_place = [place](const Look& look) { return look.place == place; };
  if (std::count_if(looks_.begin(), looks_.end(), of_place) <= looks_kept_) return;
  const auto oldest = std::find_if(looks_.begin(), looks_.end(), of_place) - looks_.begin();
  looks_.erase(looks_.begin() + oldest);
  const auto forget = [oldest](Grid& grid) {
    if (oldest < static_cast<std::ptrdiff_t>(grid.T_map_left.size())) {
      grid.T_map_left.erase(grid.T_map_left.begin() + oldest);
    }
  };
  forget(current_);
  if (next_) forget(*next_);
}

bool MapBuilder::has_moved(const std::vector<Pose>& T_map_place) const {
  // The far end of a look swings with its heading; most points are nearer than this.
  constexpr double kReach_m = 4;
  for (size_t i = 0; i < current_.T_map_left.size(); ++i) {
    const Pose now = T_map_place[looks_[i].place] * looks_[i].T_place_left;
    const Pose moved = current_.T_map_left[i].inverse() * now;
    const double reach_m = moved.translation().norm() + kReach_m * rotation_angle_rad(moved.linear());
    if (reach_m > options_.cell_m / 2) return true;
  }
  return false;
}

void MapBuilder::fill(Grid& grid, const std::vector<Pose>& T_map_place, size_t looks) const {
  const size_t end = std::min(grid.T_map_left.size() + looks, looks_.size());
  for (size_t i = grid.T_map_left.size(); i < end; ++i) {
    const Pose T_map_left = T_map_place[looks_[i].place] * looks_[i].T_place_left;
    grid.mapper.add(T_map_left, *looks_[i].observations);
    grid.T_map_left.push_back(T_map_left);
  }
}

}  // namespace groundloop::slam
