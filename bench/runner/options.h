#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim/cache/pair_cache.h"
#include "sim/scenario/scenario.h"
#include "slam/types/oracle.h"

namespace groundloop::bench {

/// `--seed A..B`, both included; `--seed S` is S..S.
struct SeedRange {
  uint64_t first = 1;
  uint64_t last = 1;
};

/// Stages whose work is replaced by exact answers; none in every ordinary run.
using OracleStages = std::set<slam::OracleStage>;

/// "tracking+stereo"; empty when nothing is replaced.
std::string name_of(const OracleStages& stages);

/// Where finished pairs are kept from run to run.
struct CacheChoice {
  std::string folder;  ///< empty: nowhere
  uint64_t max_bytes = sim::kCacheBytes;
};

/// What `groundloop run` was asked for.
struct RunOptions {
  std::vector<std::string> scenarios;  ///< scenario files, at least one
  std::optional<SeedRange> seeds;      ///< in place of each scenario's own seed
  std::optional<int64_t> frames;       ///< only the first so many pairs
  std::vector<sim::Override> set;      ///< `--set key=value`, in order
  OracleStages oracles;                ///< `--oracle stage`
  std::string
      out;  ///< run folder of a single run, parent of the run folders of several; empty: runs/NAME-SEED
  std::string junit;  ///< JUnit XML file to write; empty: none
  int jobs = 1;       ///< runs at the same time, at least 1
  bool json = false;  ///< the answer as JSON on stdout
  CacheChoice cache;
};

/// What `groundloop oracles` was asked for.
struct OracleStudyOptions {
  std::string scenario;
  std::optional<uint64_t> seed;    ///< in place of the scenario's
  std::optional<int64_t> frames;   ///< only the first so many pairs
  std::vector<sim::Override> set;  ///< `--set key=value`, in order
  std::string out;                 ///< parent of the run folders; empty: runs/NAME-SEED-oracles
  int jobs = 1;                    ///< runs at the same time, at least 1
  bool json = false;               ///< the answer as JSON on stdout
  CacheChoice cache;
};

/// What `groundloop replay` was asked for.
struct ReplayOptions {
  std::string dir;                 ///< recorded sequence
  std::string format;              ///< "kitti" or "euroc"; empty: told from the folder
  std::string preset = "default";  ///< preset of the core
  std::vector<sim::Override>
      set;                        ///< options of the core (`tracking.max_features=400`), on top of the preset
  std::optional<int64_t> frames;  ///< only the first so many pairs
  std::vector<std::string> calibration;  ///< files of a stereo calibration; the images are raw then
  std::string truth;              ///< trajectory file to judge by; empty: the sequence's own, if it has one
  std::string out;                ///< run folder; empty: runs/NAME of the sequence's folder
  bool json = false;              ///< the answer as JSON on stdout
};

/// How a long job talks to whoever started it; called from any thread, one call at a time.
struct JobControl {
  /// (name of the run, pairs done, pairs in all)
  std::function<void(const std::string& run, int64_t done, int64_t total)> progress;
  /// A line about a run that is worth knowing before its end; may be empty.
  std::function<void(const std::string& run, const std::string& line)> note;
  /// Becomes true when the job is to stop cleanly (Ctrl-C); never null.
  const std::atomic<bool>* stop = nullptr;
};

}  // namespace groundloop::bench
