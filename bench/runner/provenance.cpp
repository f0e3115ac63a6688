#include "bench/runner/provenance.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>

namespace groundloop::bench {

namespace {

std::string sha256_of_stream(std::istream& in) {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  std::array<char, 65536> block;
  while (in.read(block.data(), block.size()) || in.gcount() > 0) {
    EVP_DigestUpdate(context.get(), block.data(), static_cast<size_t>(in.gcount()));
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned int length = 0;
  EVP_DigestFinal_ex(context.get(), digest.data(), &length);
  std::string text;
  for (unsigned int i = 0; i < length; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

}  // namespace

std::string sha256_of_file(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return in ? sha256_of_stream(in) : "";
}

std::string sha256_of_text(const std::string& text) {
  std::istringstream in(text);
  return sha256_of_stream(in);
}

std::string instruction_set() {
#if defined(__x86_64__)
  std::string text = "x86-64";
  if (__builtin_cpu_supports("sse4.1")) text += " sse4.1";
  if (__builtin_cpu_supports("avx")) text += " avx";
  if (__builtin_cpu_supports("avx2")) text += " avx2";
  if (__builtin_cpu_supports("fma")) text += " fma";
  if (__builtin_cpu_supports("avx512f")) text += " avx512f";
  return text;
#else
  return "baseline";
#endif
}

double memory_mb() {
  // Asked for after every frame: opening the file would take most of the time.
  static const int statm = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  std::array<char, 128> text{};
  int64_t all_pages = 0, resident_pages = 0;
  if (pread(statm, text.data(), text.size() - 1, 0) <= 0 ||
      std::sscanf(text.data(), "%" SCNd64 " %" SCNd64, &all_pages, &resident_pages) != 2) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return static_cast<double>(resident_pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024 * 1024);
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace groundloop::bench
