#include "sim/cache/pair_cache.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "sim/cache/pair_codec.h"
#include "slam/types/config.h"
#include "tests/sim/cache/noisy_pair.h"

namespace groundloop::sim {
namespace {

namespace fs = std::filesystem;
const cv::Size kSize(96, 64);

bool same(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0; }

ContentKey key_of(uint64_t number) {
  KeyBuilder builder;
  builder.add(number);
  return builder.key();
}

/// Pair `number` of a row of different ones.
cv::Mat left_of(uint64_t number) { return noisy_image(kSize, 2 * number); }
cv::Mat right_of(uint64_t number) { return noisy_image(kSize, 2 * number + 1); }

class PairCacheTest : public testing::Test {
 protected:
  PairCacheTest()
      : folder_(fs::temp_directory_path() / (std::string("pair_cache_") +
                                             testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
  }
  ~PairCacheTest() override { fs::remove_all(folder_); }

  std::vector<fs::path> files(const std::string& extension) const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      if (entry.path().extension() == extension) found.push_back(entry.path());
    }
    return found;
  }
  void store(PairCache& cache, uint64_t number) const {
    cache.store(key_of(number), left_of(number), right_of(number));
  }
  /// Whether the cache has pair `number`; what it gives must be right.
  static bool holds(PairCache& cache, uint64_t number) {
    cv::Mat left, right;
    if (!cache.find(key_of(number), kSize, left, right)) return false;
    EXPECT_TRUE(same(left, left_of(number))) << number;
    EXPECT_TRUE(same(right, right_of(number))) << number;
    return true;
  }

  const fs::path folder_;
};

TEST(PairCodec, GivesBackEveryPixel) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(640, 3), cv::Size(3, 480), cv::Size(97, 41)}) {
    cv::Mat left = noisy_image(size, 7), right = noisy_image(size, 8);
    left.at<uint8_t>(0, 0) = 0;
    right.at<uint8_t>(size.height - 1, size.width - 1) = 255;
    std::vector<uint8_t> bytes;
    pack_pair(left, right, bytes);
    cv::Mat left_again, right_again;
    ASSERT_TRUE(unpack_pair(bytes.data(), bytes.size(), size, left_again, right_again));
    EXPECT_TRUE(same(left, left_again));
    EXPECT_TRUE(same(right, right_again));
  }
}

TEST(PairCodec, TakesPartsOfLargerImages) {
  const cv::Mat large = noisy_image({200, 100}, 1);
  const cv::Mat left = large(cv::Rect(10, 5, 60, 40)), right = large(cv::Rect(90, 50, 60, 40));
  std::vector<uint8_t> bytes;
  pack_pair(left, right, bytes);
  cv::Mat left_again, right_again;
  ASSERT_TRUE(unpack_pair(bytes.data(), bytes.size(), {60, 40}, left_again, right_again));
  EXPECT_TRUE(same(left, left_again));
  EXPECT_TRUE(same(right, right_again));
}

TEST(PairCodec, RefusesWhatItDidNotWrite) {
  std::vector<uint8_t> bytes;
  pack_pair(left_of(1), right_of(1), bytes);
  cv::Mat left, right;
  EXPECT_FALSE(unpack_pair(bytes.data(), bytes.size(), {96, 63}, left, right));
  EXPECT_FALSE(unpack_pair(bytes.data(), bytes.size() - 1, kSize, left, right));
  EXPECT_FALSE(unpack_pair(bytes.data(), 0, kSize, left, right));
  int accepted = 0;
  for (size_t i = 0; i < bytes.size(); i += 7) {  // any changed byte
    bytes[i] ^= 0x10;
    accepted += unpack_pair(bytes.data(), bytes.size(), kSize, left, right) ? 1 : 0;
    bytes[i] ^= 0x10;
  }
  EXPECT_EQ(accepted, 0);
  EXPECT_TRUE(unpack_pair(bytes.data(), bytes.size(), kSize, left, right));
}

TEST_F(PairCacheTest, FindsWhatWasStoredAlsoLater) {
  {
    PairCache cache(folder_);
    EXPECT_FALSE(holds(cache, 1));
    for (uint64_t number = 1; number <= 5; ++number) store(cache, number);
    EXPECT_EQ(cache.stored(), 5);
    EXPECT_EQ(cache.status().pairs, 5U);
  }
  PairCache cache(folder_);
  for (uint64_t number = 1; number <= 5; ++number) EXPECT_TRUE(holds(cache, number));
  EXPECT_FALSE(holds(cache, 6));
  EXPECT_EQ(cache.found(), 5);
  const PairCache::Status status = cache.status();
  EXPECT_EQ(cache.clear(), status.bytes);
  EXPECT_FALSE(holds(cache, 1));
  EXPECT_EQ(cache.status().pairs, 0U);
}

TEST_F(PairCacheTest, DamagedPairsAreDroppedAndCanBeStoredAgain) {
  PairCache cache(folder_);
  for (const auto& damage : std::vector<std::function<void(const fs::path&)>>{
           [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); },
           [](const fs::path& file) { fs::resize_file(file, 0); },
           [](const fs::path& file) {
             std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
             bytes.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
             bytes.put('\x55').put('\x2a');
           }}) {
    store(cache, 3);
    ASSERT_EQ(files(".pair").size(), 1U);
    damage(files(".pair").front());
    EXPECT_FALSE(holds(cache, 3));
    EXPECT_TRUE(files(".pair").empty());
  }
  store(cache, 3);
  EXPECT_TRUE(holds(cache, 3));
}

TEST_F(PairCacheTest, APairUnderAnothersNameIsDropped) {
  PairCache cache(folder_);
  store(cache, 1);
  const std::string one = key_of(1).hex(), two = key_of(2).hex();
  fs::create_directories(folder_ / two.substr(0, 2));
  fs::rename(folder_ / one.substr(0, 2) / (one + ".pair"), folder_ / two.substr(0, 2) / (two + ".pair"));
  EXPECT_FALSE(holds(cache, 2));
  EXPECT_TRUE(files(".pair").empty());
}

TEST_F(PairCacheTest, DropsWhatWasNotUsedForLongest) {
  uint64_t bytes_a_pair = 0;
  {
    PairCache cache(folder_);
    for (uint64_t number = 0; number < 10; ++number) store(cache, number);
    bytes_a_pair = cache.status().bytes / 10;
  }
  PairCache cache(folder_, 5 * bytes_a_pair + bytes_a_pair / 2);
  for (uint64_t number = 0; number < 10; ++number) {             // used in the order 3, 4, .. 9, 0, 1, 2
    std::this_thread::sleep_for(std::chrono::milliseconds(10));  // file times are those of the kernel's ticks
    ASSERT_TRUE(holds(cache, (number + 3) % 10));
  }
  cache.trim();
  EXPECT_LE(cache.status().bytes, cache.max_bytes());
  EXPECT_GE(cache.status().pairs, 4U);
  for (uint64_t number : {0, 1, 2, 9}) EXPECT_TRUE(holds(cache, number)) << number;
  for (uint64_t number : {3, 4, 5, 6, 7}) EXPECT_FALSE(holds(cache, number)) << number;
}

TEST_F(PairCacheTest, StoringNeverGrowsFarBeyondTheSize) {
  PairCache cache(folder_, 60'000);
  for (uint64_t number = 0; number < 100; ++number) store(cache, number);
  EXPECT_GT(cache.stored() * cache.status().bytes / std::max<uint64_t>(cache.status().pairs, 1), 200'000U);
  EXPECT_LT(cache.status().bytes, 70'000U);
  EXPECT_TRUE(holds(cache, 99));
}

TEST_F(PairCacheTest, SeveralThreadsAndObjects) {
  PairCache one(folder_), two(folder_);
  std::vector<std::thread> threads;
  for (PairCache* cache : {&one, &two, &one, &two}) {
    threads.emplace_back([this, cache] {
      for (int round = 0; round < 3; ++round) {
        for (uint64_t number = 0; number < 20; ++number) {
          if (!holds(*cache, number)) store(*cache, number);
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (uint64_t number = 0; number < 20; ++number) EXPECT_TRUE(holds(one, number));
  EXPECT_TRUE(files(".part").empty());
}

TEST_F(PairCacheTest, AKilledWriterHarmsNobody) {
  const pid_t writer = fork();
  if (writer == 0) {
    PairCache cache(folder_);
    for (uint64_t number = 0;; number = (number + 1) % 50) store(cache, number);
  }
  PairCache cache(folder_);
  while (cache.status().pairs < 20) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(writer, SIGKILL);
  waitpid(writer, nullptr, 0);
  int held = 0;
  for (uint64_t number = 0; number < 50; ++number) held += holds(cache, number) ? 1 : 0;
  EXPECT_GE(held, 20);
  EXPECT_LE(files(".part").size(), 1U);

  // what it left half written goes when it is old enough that nobody can be writing it
  const fs::path left_over = folder_ / "00" / "0.1.part";
  fs::create_directories(folder_ / "00");
  std::ofstream(left_over) << "half a pair";
  cache.trim();
  EXPECT_TRUE(fs::exists(left_over));
  fs::last_write_time(left_over, fs::file_time_type::clock::now() - std::chrono::hours(2));
  cache.trim();
  EXPECT_FALSE(fs::exists(left_over));
}

TEST_F(PairCacheTest, AFolderThatCannotBeMadeIsBadInput) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "file") << "in the way";
  const std::string wanted = (folder_ / "file" / "cache").string();
  try {
    PairCache cache(wanted);
    FAIL() << "expected an InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().key, "--cache");
    EXPECT_EQ(error.problems().front().value, wanted);
  }
}

TEST_F(PairCacheTest, WhatCannotBeWrittenIsNotKept) {
  PairCache cache(folder_);
  fs::remove_all(folder_);
  std::ofstream(folder_) << "no folder any more";
  store(cache, 1);
  EXPECT_FALSE(holds(cache, 1));
  EXPECT_EQ(cache.stored(), 0);
}

class CacheFolder : public testing::Test {
 protected:
  ~CacheFolder() override {
    for (const auto& [name, value] : before_) {
      if (value) {
        setenv(name, value->c_str(), 1);
      } else {
        unsetenv(name);
      }
    }
  }
  void set(const char* name, const char* value) {
    const char* const before = std::getenv(name);
    before_.emplace_back(name, before == nullptr ? std::nullopt : std::optional<std::string>(before));
    value == nullptr ? unsetenv(name) : setenv(name, value, 1);
  }
  std::vector<std::pair<const char*, std::optional<std::string>>> before_;
};

TEST_F(CacheFolder, IsTheUsersUnlessChosen) {
  set("GROUNDLOOP_CACHE", nullptr);
  set("XDG_CACHE_HOME", nullptr);
  set("HOME", "/users/lin");
  EXPECT_EQ(default_cache_folder(), "/users/lin/.cache/groundloop");
  set("XDG_CACHE_HOME", "/caches/lin");
  EXPECT_EQ(default_cache_folder(), "/caches/lin/groundloop");
  set("GROUNDLOOP_CACHE", "/data/pairs");
  EXPECT_EQ(default_cache_folder(), "/data/pairs");
  set("GROUNDLOOP_CACHE", "off");
  EXPECT_EQ(default_cache_folder(), "");
}

}  // namespace
}  // namespace groundloop::sim
