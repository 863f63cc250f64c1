// Helpers of the elementary functions: a double as its bits, and a number as a sum of two.
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
constexpr std::uint32_t kInfinite = 0x7ff00000;  // high word of infinity; NaNs are above

// hi + lo; lo is smaller than a rounding of hi.
struct Sum {
  double hi, lo;
};

// x = quadrant pi/2 + rest, |rest| <= pi/4; only the quadrant's last two bits matter.
struct Reduced {
  Sum rest;
  unsigned quadrant;
};
Reduced reduce(double x);

// log(x) with 15 bits more than a double holds. Input: x's bits, with an exponent below zero if x is
// subnormal.
Sum long_log(std::uint64_t bits);

// Functions that other functions here use.
double exp_m1(double x);
double arc_tangent(double x);

}  // namespace enc::math
