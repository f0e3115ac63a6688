#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <string>

namespace groundloop::bench {

/// Shows how far runs are, with the time left: a bar that redraws itself on a terminal, else one line a
/// tenth. Every finished run leaves one line. Calls must not overlap (the runner makes one at a time).
class Progress {
 public:
  /// On stderr: a bar when that is a terminal.
  Progress();
  /// @param now_s  a clock that never goes back [s]
  Progress(std::ostream& out, bool terminal, std::function<double()> now_s);
  /// Ends a bar that was left unfinished.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param run    name shown
  /// @param total  pairs in all, at least 1; done == total finishes the run
  void update(const std::string& run, int64_t done, int64_t total);
  /// A line of its own about a run.
  void note(const std::string& run, const std::string& line);

 private:
  struct Run {
    double start_s = 0;  ///< time and pairs done when it was first heard of
    int64_t start_done = 0;
    int64_t done = 0;
    int64_t total = 0;
    int tenths_shown = 0;
  };

  void draw_bar();
  void clear_bar();

  std::ostream& out_;
  bool terminal_;
  std::function<double()> now_s_;
  std::map<std::string, Run> running_;
  double last_drawn_s_;
  bool bar_shown_ = false;
};

}  // namespace groundloop::bench
