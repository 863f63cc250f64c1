#include <cstdlib>

#include "core/vision/stereo/match_kernel.h"

namespace enc::match_kernel {
namespace {

void compare(const std::uint8_t* block, std::size_t block_stride, const std::uint8_t* strip,
             std::size_t strip_stride, int columns, int rows, int count, std::uint16_t* cost) {
  for (int k = 0; k < count; ++k) {
    unsigned sum = 0;
    for (std::size_t y = 0; y < static_cast<std::size_t>(rows); ++y) {
      const std::uint8_t* a = block + y * block_stride;
      const std::uint8_t* b = strip + y * strip_stride + k;
      for (int x = 0; x < columns; ++x) sum += static_cast<unsigned>(std::abs(int{a[x]} - int{b[x]}));
    }
    cost[k] = static_cast<std::uint16_t>(sum);
  }
}

void compare_masked(const std::uint8_t* block, std::size_t block_stride, const std::uint8_t* mask,
                    std::size_t mask_stride, const std::uint8_t* strip, std::size_t strip_stride, int columns,
                    int rows, int count, std::uint16_t* cost) {
  for (int k = 0; k < count; ++k) {
    unsigned sum = 0;
    for (std::size_t y = 0; y < static_cast<std::size_t>(rows); ++y) {
      const std::uint8_t* a = block + y * block_stride;
      const std::uint8_t* b = strip + y * strip_stride + k;
      const std::uint8_t* on = mask + y * mask_stride;
      for (int x = 0; x < columns; ++x)
        if (on[x] != 0) sum += static_cast<unsigned>(std::abs(int{a[x]} - int{b[x]}));
    }
    cost[k] = static_cast<std::uint16_t>(sum);
  }
}

int least(std::uint16_t* cost, int count) {
  int best = 0;
  for (int k = 1; k < count; ++k)
    if (cost[k] < cost[best]) best = k;
  return best;
}

}  // namespace

Kernel plain() { return {compare, compare_masked, least}; }

bool has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

Kernel best() {
  static const Kernel kBest = has_avx2() && avx2().compare != nullptr ? avx2() : plain();
  return kBest;
}

}  // namespace enc::match_kernel
