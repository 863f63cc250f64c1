// The inner loops of matching, without types of ours: one file of them is compiled for AVX2, and whatever it
// included would be, too. Both sets give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace enc::match_kernel {

inline constexpr int kMost = 512;  // places that one call compares
inline constexpr int kSlack = 32;  // bytes behind the last place of a row that may be read

// cost[k] = sum of |block - strip| over `rows` rows of `columns` (8, 12 or 16) bytes, the strip from its k-th
// byte, for k < count. `cost` has room for count rounded up to 16.
using Compare = void (*)(const std::uint8_t* block, std::size_t block_stride, const std::uint8_t* strip,
                         std::size_t strip_stride, int columns, int rows, int count, std::uint16_t* cost);
// The same of those bytes of the block alone where `mask`, of the same rows and columns, is not 0.
using CompareMasked = void (*)(const std::uint8_t* block, std::size_t block_stride, const std::uint8_t* mask,
                               std::size_t mask_stride, const std::uint8_t* strip, std::size_t strip_stride,
                               int columns, int rows, int count, std::uint16_t* cost);
// Index of the least of count > 0 numbers, the first of equal ones. Those up to the next multiple of 16 are
// overwritten.
using Least = int (*)(std::uint16_t* cost, int count);

struct Kernel {
  Compare compare = nullptr;
  CompareMasked compare_masked = nullptr;
  Least least = nullptr;
};
[[nodiscard]] Kernel plain();
[[nodiscard]] Kernel avx2();  // null where it was not compiled for this kind of processor
[[nodiscard]] bool has_avx2();
// The fastest that this processor has.
[[nodiscard]] Kernel best();

}  // namespace enc::match_kernel
