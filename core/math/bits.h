// Helpers of the elementary functions: a double as its bits, a number as a sum of two, and tables.
#pragma once
#include <bit>
#include <cstdint>

namespace enc::math {

inline std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }
inline double from_bits(std::uint64_t bits) { return std::bit_cast<double>(bits); }

// Sign, exponent and the first 20 bits of the fraction: enough to find the range of x.
inline std::uint32_t high_word(double x) { return static_cast<std::uint32_t>(bits_of(x) >> 32); }
// x with the first 21 bits of its fraction: its square is exact.
inline double short_of(double x) { return from_bits(bits_of(x) & 0xffffffff00000000); }

constexpr std::uint32_t kNoSign = 0x7fffffff;
constexpr std::uint32_t kInfinite = 0x7ff00000;  // high word of infinity; those of NaNs are above

// hi + lo; lo is smaller than a rounding of hi.
struct Sum {
  double hi, lo;
};

// Tables of exp, log and pow (tables.cpp: Copyright (c) 2018, Arm Limited, MIT). c is the middle of a piece
// of [0.7, 1.4], chosen for small errors of its entries.

// 2^(i/128): error of the nearest double, and that double's bits with i subtracted from the exponent.
extern const std::uint64_t kExpTable[256];

// 1/c, log(c), and c itself as two doubles.
struct LogRow {
  double inverse, log, c, c_tail;
};
extern const LogRow kLogTable[128];

// 1/c with few bits, log(c) as two doubles.
struct PowRow {
  double inverse, log, log_tail;
};
extern const PowRow kPowTable[128];

}  // namespace enc::math
