#include "sim/cache/pair_codec.h"

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace groundloop::sim {
namespace {

constexpr int kLevel = 1;

/// Working memory of one thread.
struct Workshop {
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> packer{ZSTD_createCCtx(), ZSTD_freeCCtx};
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> unpacker{ZSTD_createDCtx(), ZSTD_freeDCtx};
  std::vector<uint8_t> differences;  ///< of the left image, then of the right one

  Workshop() {
    ZSTD_CCtx_setParameter(packer.get(), ZSTD_c_compressionLevel, kLevel);
    ZSTD_CCtx_setParameter(packer.get(), ZSTD_c_checksumFlag, 1);
  }
};

Workshop& workshop() {
  thread_local Workshop mine;
  return mine;
}

/// @return where the next image's differences go
uint8_t* subtract_rows(const cv::Mat& image, uint8_t* to) {
  const auto cols = static_cast<size_t>(image.cols);
  for (int row = 0; row < image.rows; ++row, to += cols) {
    const uint8_t* const from = image.ptr(row);
    if (row == 0) {
      std::copy_n(from, cols, to);
      continue;
    }
    const uint8_t* const above = image.ptr(row - 1);
    for (size_t col = 0; col < cols; ++col) to[col] = static_cast<uint8_t>(from[col] - above[col]);
  }
  return to;
}

const uint8_t* add_rows(const uint8_t* from, cv::Mat& image) {
  const auto cols = static_cast<size_t>(image.cols);
  for (int row = 0; row < image.rows; ++row, from += cols) {
    uint8_t* const to = image.ptr(row);
    if (row == 0) {
      std::copy_n(from, cols, to);
      continue;
    }
    const uint8_t* const above = image.ptr(row - 1);
    for (size_t col = 0; col < cols; ++col) to[col] = static_cast<uint8_t>(from[col] + above[col]);
  }
  return from;
}

}  // namespace

void pack_pair(const cv::Mat& left, const cv::Mat& right, std::vector<uint8_t>& bytes) {
  CV_Assert(left.type() == CV_8UC1 && right.type() == CV_8UC1 && left.size() == right.size());
  Workshop& shop = workshop();
  shop.differences.resize(left.total() + right.total());
  subtract_rows(right, subtract_rows(left, shop.differences.data()));
  bytes.resize(ZSTD_compressBound(shop.differences.size()));
  const size_t count = ZSTD_compress2(shop.packer.get(), bytes.data(), bytes.size(), shop.differences.data(),
                                      shop.differences.size());
  if (ZSTD_isError(count) != 0) throw std::runtime_error(ZSTD_getErrorName(count));
  bytes.resize(count);
}

bool unpack_pair(const uint8_t* bytes, size_t count, cv::Size size, cv::Mat& left, cv::Mat& right) {
  Workshop& shop = workshop();
  shop.differences.resize(2 * static_cast<size_t>(size.area()));
  const size_t unpacked = ZSTD_decompressDCtx(shop.unpacker.get(), shop.differences.data(),
                                              shop.differences.size(), bytes, count);
  if (ZSTD_isError(unpacked) != 0 || unpacked != shop.differences.size()) return false;
  left.create(size, CV_8UC1);
  right.create(size, CV_8UC1);
  add_rows(add_rows(shop.differences.data(), left), right);
  return true;
}

}  // namespace groundloop::sim
