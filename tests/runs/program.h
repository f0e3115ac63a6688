#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace groundloop::bench {

/// What a program left: exit code (-1: ended by a signal) and output.
struct Answer {
  int exit_code = -1;
  int signal = 0;
  std::string out;
  std::string err;

  /// `err` without the lines of progress, and without the one that says what the pixels depend on.
  std::string complaint() const;
};

/// Runs `groundloop ARGUMENTS...` and waits for its end.
Answer groundloop(const std::vector<std::string>& arguments);

/// The same, sent `signal` as soon as it reports progress.
Answer groundloop_with_signal(const std::vector<std::string>& arguments, int signal);

/// An empty folder of the running test's own, removed at its end.
class Workspace {
 public:
  Workspace();
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  std::string path(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;
  /// Names of everything in it, or in a folder of it, at any depth; sorted.
  std::vector<std::string> entries(const std::string& folder = "") const;

 private:
  std::filesystem::path path_;
};

std::string text_of(const std::filesystem::path& file);
std::vector<std::string> lines_of(const std::filesystem::path& file);

}  // namespace groundloop::bench
