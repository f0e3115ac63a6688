#include "sim/cache/pair_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "sim/cache/pair_codec.h"
#include "slam/types/config.h"

namespace groundloop::sim {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kMagic = "groundloop pair 1\n";
constexpr const char* kPairs = ".pair";
constexpr const char* kTemporary = ".part";
constexpr std::chrono::hours kForgotten(1);  ///< age of a temporary file whose writer must be dead
constexpr double kTrimTo = 0.9;              ///< part of the size that is left after trimming
constexpr uint64_t kTrimsPerSize = 16;       ///< trims while as much is written as the cache may hold

/// A file descriptor that closes itself.
class File {
 public:
  File(const std::string& name, int flags) : descriptor_(open(name.c_str(), flags | O_CLOEXEC, 0644)) {}
  ~File() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int descriptor() const { return descriptor_; }
  bool is_open() const { return descriptor_ >= 0; }

 private:
  int descriptor_;
};

bool write_all(int file, const void* data, size_t size) {
  const auto* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(file, from, size);
    if (written <= 0) return false;
    from += written;
    size -= static_cast<size_t>(written);
  }
  return true;
}

/// The whole file; false when it cannot be read.
bool read_all(const File& file, std::vector<uint8_t>& bytes) {
  struct stat about {};
  if (!file.is_open() || fstat(file.descriptor(), &about) != 0) return false;
  bytes.resize(static_cast<size_t>(about.st_size));
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = read(file.descriptor(), bytes.data() + done, bytes.size() - done);
    if (got <= 0) return false;
    done += static_cast<size_t>(got);
  }
  return true;
}

struct Entry {
  fs::path file;
  timespec used{};
  uint64_t bytes = 0;
};

bool used_before(const Entry& a, const Entry& b) {
  return std::pair(a.used.tv_sec, a.used.tv_nsec) < std::pair(b.used.tv_sec, b.used.tv_nsec);
}

/// Every file of the cache with one of its two endings. Files may come and go meanwhile.
std::vector<Entry> entries(const std::string& folder, const char* ending) {
  std::vector<Entry> found;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() != ending) continue;
    struct stat about {};
    if (stat(it->path().c_str(), &about) != 0 || !S_ISREG(about.st_mode)) continue;
    found.push_back({it->path(), about.st_mtim, static_cast<uint64_t>(about.st_size)});
  }
  return found;
}

void drop_forgotten(const std::string& folder) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  for (const Entry& part : entries(folder, kTemporary)) {
    if (now - std::chrono::seconds(part.used.tv_sec) > kForgotten) unlink(part.file.c_str());
  }
}

}  // namespace

PairCache::PairCache(std::string folder, uint64_t max_bytes)
    : folder_(std::move(folder)), max_bytes_(max_bytes) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error)
    throw InputError(Problem{"", 0, "--cache", folder_, "a folder that can be made: " + error.message()});
}

std::string PairCache::file_of(const ContentKey& key) const {
  const std::string name = key.hex();
  return folder_ + "/" + name.substr(0, 2) + "/" + name + kPairs;
}

bool PairCache::find(const ContentKey& key, cv::Size size, cv::Mat& left, cv::Mat& right) {
  thread_local std::vector<uint8_t> bytes;
  const std::string name = file_of(key);
  const File file(name, O_RDONLY);
  if (!file.is_open()) return false;
  const size_t head = kMagic.size() + key.bytes.size();
  const bool whole = read_all(file, bytes) && bytes.size() > head &&
                     std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0 &&
                     std::memcmp(bytes.data() + kMagic.size(), key.bytes.data(), key.bytes.size()) == 0 &&
                     unpack_pair(bytes.data() + head, bytes.size() - head, size, left, right);
  if (!whole) {
    unlink(name.c_str());
    return false;
  }
  futimens(file.descriptor(), nullptr);  // used now
  ++found_;
  return true;
}

void PairCache::store(const ContentKey& key, const cv::Mat& left, const cv::Mat& right) {
  thread_local std::vector<uint8_t> bytes;
  pack_pair(left, right, bytes);
  const std::string name = file_of(key);
  const fs::path folder = fs::path(name).parent_path();
  std::error_code error;
  fs::create_directory(folder, error);
  const std::string part = fmt::format("{}.{}.{}{}", name, getpid(), next_name_++, kTemporary);
  bool complete = false;
  {
    const File file(part, O_WRONLY | O_CREAT | O_EXCL);
    complete = file.is_open() && write_all(file.descriptor(), kMagic.data(), kMagic.size()) &&
               write_all(file.descriptor(), key.bytes.data(), key.bytes.size()) &&
               write_all(file.descriptor(), bytes.data(), bytes.size());
  }
  if (!complete || rename(part.c_str(), name.c_str()) != 0) {
    unlink(part.c_str());
    return;
  }
  ++stored_;
  bytes_since_trim_ += bytes.size();
  if (bytes_since_trim_ > max_bytes_ / kTrimsPerSize) trim();
}

void PairCache::trim() {
  const File lock(folder_ + "/lock", O_RDWR | O_CREAT);
  if (!lock.is_open() || flock(lock.descriptor(), LOCK_EX | LOCK_NB) != 0) return;  // another does it
  bytes_since_trim_ = 0;
  drop_forgotten(folder_);
  std::vector<Entry> pairs = entries(folder_, kPairs);
  uint64_t bytes = 0;
  for (const Entry& pair : pairs) bytes += pair.bytes;
  if (bytes <= max_bytes_) return;
  std::sort(pairs.begin(), pairs.end(), used_before);
  const auto wanted = static_cast<uint64_t>(kTrimTo * static_cast<double>(max_bytes_));
  for (const Entry& pair : pairs) {
    if (bytes <= wanted) break;
    unlink(pair.file.c_str());
    bytes -= pair.bytes;
  }
}

uint64_t PairCache::clear() {
  uint64_t bytes = 0;
  for (const char* ending : {kPairs, kTemporary}) {
    for (const Entry& entry : entries(folder_, ending)) {
      if (unlink(entry.file.c_str()) == 0) bytes += entry.bytes;
    }
  }
  return bytes;
}

PairCache::Status PairCache::status() const {
  Status status;
  for (const Entry& pair : entries(folder_, kPairs)) {
    ++status.pairs;
    status.bytes += pair.bytes;
  }
  return status;
}

std::string default_cache_folder() {
  const auto value = [](const char* name) -> std::string {
    const char* const text = std::getenv(name);
    return text == nullptr ? "" : text;
  };
  if (const std::string chosen = value("GROUNDLOOP_CACHE"); !chosen.empty()) {
    return chosen == "off" ? "" : chosen;
  }
  if (const std::string caches = value("XDG_CACHE_HOME"); !caches.empty()) return caches + "/groundloop";
  if (const std::string home = value("HOME"); !home.empty()) return home + "/.cache/groundloop";
  return "";
}

}  // namespace groundloop::sim
