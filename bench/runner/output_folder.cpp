#include "bench/runner/output_folder.h"

#include <unistd.h>

#include <fmt/format.h>
#include <filesystem>

#include "slam/types/config.h"

namespace groundloop::bench {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse(const std::string& destination, const std::string& why, const std::string& wanted) {
  throw InputError(Problem{"--out", 0, destination, why, wanted});
}

}  // namespace

OutputFolder::OutputFolder(const std::string& destination)
    : destination_(fs::path(destination).lexically_normal().string()) {
  while (destination_.size() > 1 && destination_.back() == '/') destination_.pop_back();
  std::error_code error;
  if (fs::exists(destination_, error)) {
    if (!fs::is_directory(destination_, error))
      refuse(destination_, "is a file", "a folder to write the run to");
    if (!fs::is_empty(destination_, error) && !fs::exists(fs::path(destination_) / "run.json", error)) {
      refuse(destination_, "holds something that is not a run", "a new folder, or an older run to replace");
    }
  }
  const fs::path parent = fs::path(destination_).parent_path();
  if (!parent.empty()) fs::create_directories(parent, error);
  if (error) refuse(destination_, error.message(), "a folder that can be written");
  temporary_ = fmt::format("{}.unfinished-{}", destination_, ::getpid());
  fs::remove_all(temporary_, error);
  fs::create_directories(fs::path(temporary_) / "figures", error);
  if (error) refuse(destination_, error.message(), "a folder that can be written");
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!published_) fs::remove_all(temporary_, ignored);
}

void OutputFolder::publish() {
  // The older run leaves its name and the new one takes it in two renames, so that nobody meets a mixture.
  const std::string replaced = fmt::format("{}.replaced-{}", destination_, ::getpid());
  std::error_code error;
  const bool older = fs::exists(destination_, error);
  if (older) fs::rename(destination_, replaced, error);
  if (!error) fs::rename(temporary_, destination_, error);
  if (error) refuse(destination_, error.message(), "a folder that can be renamed");
  published_ = true;
  if (older) fs::remove_all(replaced, error);
}

}  // namespace groundloop::bench
