#include "bench/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>

namespace groundloop::bench {
namespace {

constexpr double kRedraw_s = 0.1;
constexpr int kBarWidth = 24;

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// 83 s -> "1:23"
std::string minutes(double seconds) {
  const auto whole = static_cast<int64_t>(std::lround(std::max(0.0, seconds)));
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

/// @param done, left  pairs done in the elapsed time, and yet to do
std::string time_left(double elapsed_s, int64_t done, int64_t left) {
  if (done <= 0) return "";
  const double left_s = elapsed_s * static_cast<double>(left) / static_cast<double>(done);
  return fmt::format(", {} left", minutes(left_s));
}

}  // namespace

Progress::Progress() : Progress(std::cerr, isatty(STDERR_FILENO) != 0, steady_s) {}

Progress::Progress(std::ostream& out, bool terminal, std::function<double()> now_s)
    : out_(out),
      terminal_(terminal),
      now_s_(std::move(now_s)),
      last_drawn_s_(-std::numeric_limits<double>::infinity()) {}

Progress::~Progress() { clear_bar(); }

void Progress::update(const std::string& name, int64_t done, int64_t total) {
  const double now_s = now_s_();
  const auto [entry, is_new] = running_.try_emplace(name);
  Run& run = entry->second;
  if (is_new) run.start_s = now_s, run.start_done = done;
  run.done = done;
  run.total = std::max<int64_t>(total, 1);

  if (run.done >= run.total) {
    clear_bar();
    out_ << fmt::format("{}: {} pairs in {}\n", name, run.done, minutes(now_s - run.start_s)) << std::flush;
    running_.erase(entry);
    return;
  }
  if (terminal_) {
    if (now_s - last_drawn_s_ >= kRedraw_s) draw_bar();
    return;
  }
  const auto tenths = static_cast<int>(10 * run.done / run.total);
  if (tenths <= run.tenths_shown) return;
  run.tenths_shown = tenths;
  out_ << fmt::format("{}: {} % ({} of {} pairs){}\n", name, 10 * tenths, run.done, run.total,
                      time_left(now_s - run.start_s, run.done - run.start_done, run.total - run.done))
       << std::flush;
}

void Progress::note(const std::string& name, const std::string& line) {
  clear_bar();
  out_ << fmt::format("{}: {}\n", name, line) << std::flush;
}

void Progress::draw_bar() {
  const double now_s = now_s_();
  std::string names;
  int64_t done = 0, done_since_start = 0, total = 0;
  double start_s = now_s;
  for (const auto& [name, run] : running_) {
    names += (names.empty() ? "" : ", ") + name;
    done += run.done;
    done_since_start += run.done - run.start_done;
    total += run.total;
    start_s = std::min(start_s, run.start_s);
  }
  const auto filled = static_cast<size_t>(kBarWidth * done / total);
  out_ << fmt::format("\r\x1b[K{} [{}{}] {:3} %{}", names, std::string(filled, '#'),
                      std::string(kBarWidth - filled, '.'), 100 * done / total,
                      time_left(now_s - start_s, done_since_start, total - done))
       << std::flush;
  last_drawn_s_ = now_s;
  bar_shown_ = true;
}

void Progress::clear_bar() {
  if (!bar_shown_) return;
  out_ << "\r\x1b[K" << std::flush;
  bar_shown_ = false;
}

}  // namespace groundloop::bench
