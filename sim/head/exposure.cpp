#include "sim/head/exposure.h"

#include <algorithm>
#include <cmath>

namespace groundloop::sim {
namespace {

double amplification(double gain_db) { return std::pow(10, gain_db / 20); }
double decibels(double amplification) { return 20 * std::log10(amplification); }

}  // namespace

void AutoExposureModel::check(ConfigReader& reader) const {
  if (min_time_s > max_time_s) reader.problem("min_time_s", "a time not above max_time_s");
}

double ExposureModel::longest_s() const {
  const double longest_left_s = automatic ? std::max(time_s, automatic->max_time_s) : time_s;
  return longest_left_s * std::max(1.0, right_time_factor) + readout_s;
}

std::vector<double> ExposureModel::sub_frame_times_s() const {
  std::vector<double> times_s;
  for (int i = 0; i < sub_frames; ++i) times_s.push_back(longest_s() * ((i + 0.5) / sub_frames - 0.5));
  return times_s;
}

ExposureSetting right_setting(const ExposureModel& model, const ExposureSetting& left) {
  return {left.time_s * model.right_time_factor, left.gain_db + model.right_gain_db};
}

std::vector<float> shutter_weights(const ExposureModel& model, double time_s, int row, int rows) {
  const double span_s = model.longest_s(), part_s = span_s / model.sub_frames;
  const double middle_s = model.readout_s * ((row + 0.5) / rows - 0.5);
  const double open_s = middle_s - 0.5 * time_s, close_s = middle_s + 0.5 * time_s;
  std::vector<float> weights;
  for (int i = 0; i < model.sub_frames; ++i) {
    const double begin_s = i * part_s - 0.5 * span_s;
    const double shared_s = std::min(close_s, begin_s + part_s) - std::max(open_s, begin_s);
    weights.push_back(static_cast<float>(std::max(0.0, shared_s) / time_s));
  }
  return weights;
}

ExposureControl::ExposureControl(const ExposureModel& model) : model_(model) {
  const int known = model.automatic ? model.automatic->lag_frames : 1;
  coming_.assign(static_cast<size_t>(known), {model.time_s, model.gain_db});
}

ExposureSetting ExposureControl::next() {
  taken_ = coming_.front();
  if (model_.automatic) coming_.pop_front();
  return taken_;
}

void ExposureControl::observe(double mean_grey) {
  if (model_.automatic) coming_.push_back(decided(taken_, mean_grey));
}

/// Light times gain is brought towards the target: first by the time, then by the gain.
ExposureSetting ExposureControl::decided(const ExposureSetting& taken, double mean_grey) const {
  constexpr double kDarkest_grey = 1;  // a black image says no more than "much brighter, please"
  const AutoExposureModel& law = *model_.automatic;
  const double error = law.target_grey / std::max(mean_grey, kDarkest_grey);
  const double wanted = taken.time_s * amplification(taken.gain_db) * std::pow(error, law.speed);
  const double time_s = wanted / amplification(model_.gain_db);
  if (time_s <= law.max_time_s) return {std::max(time_s, law.min_time_s), model_.gain_db};
  const double gain_db = std::min(decibels(wanted / law.max_time_s), law.max_gain_db);
  return {law.max_time_s, std::max(gain_db, model_.gain_db)};
}

}  // namespace groundloop::sim
