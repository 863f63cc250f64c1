// The inner loops of matching, without types of ours: one of these files is compiled for AVX2, and so would
// be any included code. Both sets give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace enc::match_kernel {

inline constexpr int kMost = 512;  // positions compared in one call
inline constexpr int kSlack = 32;  // bytes behind the last position of a row that may be read

// cost[k] = sum of |block - strip| over `rows` rows of `columns` (8, 12 or 16) bytes, with the strip from its
// k-th byte, for k < count. `cost` has room for count rounded up to 16.
using Compare = void (*)(const std::uint8_t* block, std::size_t block_stride, const std::uint8_t* strip,
                         std::size_t strip_stride, int columns, int rows, int count, std::uint16_t* cost);
// As Compare, over only those bytes of the block for which `mask`, with the same rows and columns, is not 0.
using MaskedCompare = void (*)(const std::uint8_t* block, std::size_t block_stride, const std::uint8_t* mask,
                               std::size_t mask_stride, const std::uint8_t* strip, std::size_t strip_stride,
                               int columns, int rows, int count, std::uint16_t* cost);
// Index of the smallest of count > 0 numbers; the first if equal. The entries up to the next multiple of 16
// are overwritten.
using LeastIndex = int (*)(std::uint16_t* cost, int count);

struct Kernel {
  Compare compare = nullptr;
  MaskedCompare compare_masked = nullptr;
  LeastIndex least = nullptr;
};
[[nodiscard]] Kernel plain();
[[nodiscard]] Kernel avx2();  // null if not compiled for this kind of processor
[[nodiscard]] bool has_avx2();
// The fastest version that this processor can run.
[[nodiscard]] Kernel best();

}  // namespace enc::match_kernel
