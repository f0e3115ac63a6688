#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/verdict/verdict.h"

namespace groundloop::bench {

/// One judged run: a scenario with a seed.
struct JudgedRun {
  std::string scenario;
  uint64_t seed = 1;
  double wall_s = 0;  ///< how long it took
  Verdict verdict;
};

/// The runs as JUnit XML, which CI servers read: one test suite, one test case a run (class: the suite, name:
/// "lab_p3dx seed 1"); a run that fell short is a failure with one line a shortfall, bad input and internal
/// errors are errors.
std::string junit_xml(const std::string& suite, const std::vector<JudgedRun>& runs);

/// @throws InputError when the file cannot be written
void write_junit(const std::string& file, const std::string& suite, const std::vector<JudgedRun>& runs);

}  // namespace groundloop::bench
