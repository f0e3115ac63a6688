#include "bench/cli/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace groundloop::bench {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// A progress whose clock is set by hand.
struct Shown {
  explicit Shown(bool terminal) : progress(out, terminal, [this] { return now_s; }) {}
  std::string take() {
    std::string text = out.str();
    out.str("");
    return text;
  }

  double now_s = 1000;
  std::ostringstream out;
  Progress progress;
};

TEST(ProgressLines, OneATenthAndOneAtTheEnd) {
  Shown shown(false);
  for (int done = 1; done <= 200; ++done) {
    shown.now_s += 1;
    shown.progress.update("lab-1", done, 200);
  }
  const std::string text = shown.take();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_THAT(text, testing::StartsWith("lab-1: 10 % (20 of 200 pairs), 3:00 left\n"));
  EXPECT_THAT(text, EndsWith("lab-1: 200 pairs in 3:19\n"));
}

TEST(ProgressLines, TellTheTimeLeft) {
  Shown shown(false);
  shown.progress.update("lab-1", 0, 100);
  shown.now_s += 25;
  shown.progress.update("lab-1", 25, 100);
  EXPECT_EQ(shown.take(), "lab-1: 20 % (25 of 100 pairs), 1:15 left\n");
}

TEST(ProgressLines, OfRunsSideBySideAreTheirOwn) {
  Shown shown(false);
  shown.progress.update("a", 0, 10);
  shown.progress.update("b", 0, 10);
  shown.now_s += 60;
  shown.progress.update("a", 5, 10);
  shown.progress.update("b", 10, 10);
  EXPECT_EQ(shown.take(), "a: 50 % (5 of 10 pairs), 1:00 left\nb: 10 pairs in 1:00\n");
}

TEST(ProgressBar, RedrawsOneLine) {
  Shown shown(true);
  shown.progress.update("lab-1", 0, 100);
  shown.now_s += 30;
  shown.take();
  shown.progress.update("lab-1", 50, 100);
  EXPECT_EQ(shown.take(), "\r\x1b[Klab-1 [############............]  50 %, 0:30 left");
}

TEST(ProgressBar, DoesNotRedrawForEveryPair) {
  Shown shown(true);
  shown.progress.update("lab-1", 1, 1000);
  shown.take();
  shown.now_s += 0.01;
  shown.progress.update("lab-1", 2, 1000);
  EXPECT_EQ(shown.take(), "");
}

TEST(ProgressBar, EveryFinishedRunLeavesOneLine) {
  Shown shown(true);
  shown.progress.update("lab-1", 1, 10);
  shown.now_s += 5;
  shown.take();
  shown.progress.update("lab-1", 10, 10);
  EXPECT_EQ(shown.take(), "\r\x1b[Klab-1: 10 pairs in 0:05\n");
}

TEST(ProgressBar, NotesHaveLinesOfTheirOwn) {
  Shown shown(true);
  shown.progress.update("lab-1", 0, 100);
  shown.take();
  shown.progress.note("lab-1", "drawn by hand");
  EXPECT_EQ(shown.take(), "\r\x1b[Klab-1: drawn by hand\n");
}

TEST(ProgressBar, IsClearedWhenTheJobStops) {
  std::ostringstream out;
  {
    Progress progress(out, true, [] { return 0.0; });
    progress.update("lab-1", 1, 10);
  }
  EXPECT_THAT(out.str(), EndsWith("\r\x1b[K"));
}

TEST(ProgressBar, ShowsRunsSideBySideTogether) {
  Shown shown(true);
  shown.progress.update("a", 0, 10);
  shown.progress.update("b", 0, 10);
  shown.now_s += 10;
  shown.take();
  shown.progress.update("b", 5, 10);
  EXPECT_THAT(shown.take(), HasSubstr("a, b [######..................]  25 %, 0:30 left"));
}

}  // namespace
}  // namespace groundloop::bench
