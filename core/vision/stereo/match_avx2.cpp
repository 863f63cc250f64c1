// Compiled with -mavx2, and called only if the processor has it. It compares sixteen positions at once:
// vmpsadbw compares four bytes of the block with eight positions in each half of a register.
#include "core/vision/stereo/match_kernel.h"

#if defined(__AVX2__)
#include <immintrin.h>

namespace enc::match_kernel {
namespace {

__m128i load(const std::uint8_t* at) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(at)); }

// Positions 0 to 7 in the lower half, 8 to 15 in the upper one. The block's bytes go four at a time against
// the strip from that byte on; the third and fourth group begin eight bytes farther.
template <int fours>
__m256i row_of(const std::uint8_t* block, const std::uint8_t* strip, __m256i sum) {
  const __m256i a = _mm256_broadcastsi128_si256(load(block));
  const __m128i s8 = load(strip + 8);
  const __m256i near = _mm256_inserti128_si256(_mm256_castsi128_si256(load(strip)), s8, 1);
  sum = _mm256_add_epi16(sum, _mm256_mpsadbw_epu8(near, a, 0x00));
  sum = _mm256_add_epi16(sum, _mm256_mpsadbw_epu8(near, a, 0x2d));
  if constexpr (fours > 2) {
    const __m256i far = _mm256_inserti128_si256(_mm256_castsi128_si256(s8), load(strip + 16), 1);
    sum = _mm256_add_epi16(sum, _mm256_mpsadbw_epu8(far, a, 0x12));
    if constexpr (fours > 3) sum = _mm256_add_epi16(sum, _mm256_mpsadbw_epu8(far, a, 0x3f));
  }
  return sum;
}

template <int fours>
void compare_fours(const std::uint8_t* block, std::size_t block_stride, const std::uint8_t* strip,
                   std::size_t strip_stride, int rows, int count, std::uint16_t* cost) {
  for (int k = 0; k < count; k += 16) {
    __m256i sum = _mm256_setzero_si256();
    const std::uint8_t* a = block;
    const std::uint8_t* b = strip + k;
    for (int y = 0; y < rows; ++y, a += block_stride, b += strip_stride) sum = row_of<fours>(a, b, sum);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(cost + k), sum);
  }
}

void compare(const std::uint8_t* block, std::size_t block_stride, const std::uint8_t* strip,
             std::size_t strip_stride, int columns, int rows, int count, std::uint16_t* cost) {
  if (columns == 8) return compare_fours<2>(block, block_stride, strip, strip_stride, rows, count, cost);
  if (columns == 12) return compare_fours<3>(block, block_stride, strip, strip_stride, rows, count, cost);
  compare_fours<4>(block, block_stride, strip, strip_stride, rows, count, cost);
}

// Compares one byte of the block at a time with sixteen positions.
void compare_masked(const std::uint8_t* block, std::size_t block_stride, const std::uint8_t* mask,
                    std::size_t mask_stride, const std::uint8_t* strip, std::size_t strip_stride, int columns,
                    int rows, int count, std::uint16_t* cost) {
  struct Byte {
    const std::uint8_t* at;
    short level;
  } bytes[16 * 15];
  int chosen = 0;
  for (int y = 0; y < rows; ++y, block += block_stride, mask += mask_stride, strip += strip_stride)
    for (int x = 0; x < columns; ++x)
      if (mask[x] != 0) bytes[chosen++] = {strip + x, block[x]};
  for (int k = 0; k < count; k += 16) {
    __m256i sum = _mm256_setzero_si256();
    for (int i = 0; i < chosen; ++i) {
      const __m256i there = _mm256_cvtepu8_epi16(load(bytes[i].at + k));
      const __m256i apart = _mm256_abs_epi16(_mm256_sub_epi16(there, _mm256_set1_epi16(bytes[i].level)));
      sum = _mm256_add_epi16(sum, apart);
    }
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(cost + k), sum);
  }
}

int least(std::uint16_t* cost, int count) {
  for (int k = count; k % 16 != 0; ++k) cost[k] = 0xffff;
  __m256i low = _mm256_set1_epi16(-1);
  for (int k = 0; k < count; k += 16)
    low = _mm256_min_epu16(low, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(cost + k)));
  const __m128i half = _mm_min_epu16(_mm256_castsi256_si128(low), _mm256_extracti128_si256(low, 1));
  const __m256i sought = _mm256_set1_epi16(static_cast<short>(_mm_extract_epi16(_mm_minpos_epu16(half), 0)));
  for (int k = 0; k < count; k += 16) {
    const __m256i equal =
        _mm256_cmpeq_epi16(sought, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(cost + k)));
    const int bits = _mm256_movemask_epi8(equal);
    if (bits != 0) return k + __builtin_ctz(static_cast<unsigned>(bits)) / 2;
  }
  return 0;
}

}  // namespace

Kernel avx2() { return {compare, compare_masked, least}; }

}  // namespace enc::match_kernel
#else
namespace enc::match_kernel {
Kernel avx2() { return {}; }
}  // namespace enc::match_kernel
#endif
