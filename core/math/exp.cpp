// exp, pow, log2, log10: after exp.c and pow.c of ARM's optimized routines (by way of musl 1.2.3), their way
// without fused multiply-add. expm1 and tanh: after FreeBSD's s_expm1.c (by way of musl 1.2.3) and musl's
// tanh.c (MIT, Rich Felker and others).
//
// Copyright (c) 2018, Arm Limited.
// SPDX-License-Identifier: MIT
/*
 * ====================================================
 * Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
 *
 * Developed at SunPro, a Sun Microsystems, Inc. business.
 * Permission to use, copy, modify, and distribute this
 * software is freely granted, provided that this notice
 * is preserved.
 * ====================================================
 */
#include <cmath>
#include <limits>

#include "core/math/bits.h"

namespace enc::math {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kSign = 0x8000000000000000;

// Sign and exponent.
std::uint32_t top12(double x) { return static_cast<std::uint32_t>(bits_of(x) >> 52); }

// scale (1 + y) for a scale whose exponent exceeds its 11 bits, close to the largest and smallest numbers.
double at_the_edge(double y, std::uint64_t scale_bits, std::uint64_t k) {
  if ((k & 0x80000000) == 0) {
    const double scale = from_bits(scale_bits - (1009ULL << 52));
    return 0x1p1009 * (scale + scale * y);
  }
  scale_bits += 1022ULL << 52;
  const double scale = from_bits(scale_bits);
  double z = scale + scale * y;
  if (std::fabs(z) < 1.0) {  // subnormal: round once, at its own last place
    const double one = z < 0.0 ? -1.0 : 1.0;
    const double lo = scale - z + scale * y;
    const double hi = one + z;
    z = (hi + (one - hi + z + lo)) - one;
    if (z == 0.0) z = from_bits(scale_bits & kSign);
  }
  return 0x1p-1022 * z;
}

// exp(x + tail), negated if `negative` is kMinus and not 0: x + tail = k ln2 / 128 + r.
constexpr std::uint64_t kMinus = 0x800 << 7;
inline double exp_of(double x, double tail, std::uint64_t negative) {
  std::uint32_t range = top12(x) & 0x7ff;
  if (range - 0x3c9 >= 0x408U - 0x3c9U) {  // not 2^-54 <= |x| < 512
    if (range < 0x3c9) return negative != 0 ? -1.0 - x : 1.0 + x;
    if (range >= 0x409) {  // 1024, infinity, NaN
      if (x != x || x == kInf) return x;
      const double y = x < 0.0 ? 0.0 : kInf;
      return negative != 0 ? -y : y;
    }
    range = 0;
  }
  constexpr double kRound = 0x1.8p52;
  const double shifted = 0x1.71547652b82fep0 * 128 * x + kRound;
  const std::uint64_t k = bits_of(shifted);
  const double kd = shifted - kRound;
  const double r = x + kd * -0x1.62e42fefa0000p-8 + kd * -0x1.cf79abc9e3b3ap-47 + tail;
  const std::uint64_t at = 2 * (k % 128);
  const std::uint64_t scale_bits = kExpTable[at + 1] + ((k + negative) << 45);
  const double r2 = r * r;
  const double y = from_bits(kExpTable[at]) + r + r2 * (0x1.ffffffffffdbdp-2 + r * 0x1.555555555543cp-3) +
                   r2 * r2 * (0x1.55555cf172b91p-5 + r * 0x1.1111167a4d017p-7);
  if (range == 0) return at_the_edge(y, scale_bits, k);
  const double scale = from_bits(scale_bits);
  return scale + scale * y;
}

// Kind of y: not whole, odd or even.
enum class Parity { no, odd, even };
Parity whole(double y) {
  const double a = std::fabs(y);
  if (a >= 0x1p53) return Parity::even;
  if (a != std::floor(a)) return Parity::no;
  return (static_cast<std::uint64_t>(a) & 1) != 0 ? Parity::odd : Parity::even;
}

// Bits of x; those of a subnormal get an exponent below zero.
std::uint64_t normal_bits(double x) {
  return bits_of(x) >> 52 != 0 ? bits_of(x) : bits_of(x * 0x1p52) - (52ULL << 52);
}

// pow if x or y is zero, infinite or NaN.
double pow_of_special(double x, double y) {
  if (y == 0.0 || x == 1.0) return 1.0;
  if (x != x || y != y) return x + y;
  if (std::isinf(y)) {
    if (x == -1.0) return 1.0;
    return (std::fabs(x) < 1.0) == std::signbit(y) ? kInf : 0.0;
  }
  const double z = (x == 0.0) == std::signbit(y) ? kInf : 0.0;
  return std::signbit(x) && whole(y) == Parity::odd ? -z : z;
}

bool special(double x) { return 2 * bits_of(x) - 1 >= 2 * bits_of(kInf) - 1; }

// log(x) with 15 bits more than a double holds. Input: x's bits, with an exponent below zero if x is
// subnormal.
Sum long_log(std::uint64_t bits) {
  const std::uint64_t from = bits - 0x3fe6955500000000;
  const PowRow& row = kPowTable[(from >> 45) % 128];
  const double k = static_cast<double>(static_cast<std::int64_t>(from) >> 52);
  const std::uint64_t z_bits = bits - (from & 0xfffULL << 52);
  const double z = from_bits(z_bits);
  const double z_hi = from_bits((z_bits + (1ULL << 31)) & -1ULL << 32);
  const double r_hi = z_hi * row.inverse - 1.0;
  const double r_lo = (z - z_hi) * row.inverse;
  const double r = r_hi + r_lo;
  const double t1 = k * 0x1.62e42fefa3800p-1 + row.log;
  const double t2 = t1 + r;
  const double lo1 = k * 0x1.ef35793c76730p-45 + row.log_tail;
  const double lo2 = t1 - t2 + r;
  // - r^2 / 2
  const double ar = -0.5 * r;
  const double ar2 = r * ar;
  const double ar_hi = -0.5 * r_hi;
  const double square = r_hi * ar_hi;
  const double hi = t2 + square;
  const double lo3 = r_lo * (ar + ar_hi);
  const double lo4 = t2 - hi + square;
  const double p = r * ar2 *
                   (0x1.555555555556p-2 * -2 + r * (-0x1.0000000000006p-2 * -2) +
                    ar2 * (0x1.999999959554ep-3 * 4 + r * (-0x1.555555529a47ap-3 * 4) +
                           ar2 * (0x1.2495b9b4845e9p-3 * -8 + r * (-0x1.0002b8b263fc3p-3 * -8))));
  const double lo = lo1 + lo2 + lo3 + lo4 + p;
  const double y = hi + lo;
  return {y, hi - y + lo};
}

// log(x) times a constant, given as its first 26 bits and their remainder.
double log_times(double x, Sum factor) {
  if (special(x) || x < 0.0) return x == 0.0 ? -kInf : x < 0.0 ? kNan : x;
  const Sum log = long_log(normal_bits(x));
  const double first = from_bits(bits_of(log.hi) & -1ULL << 27);
  return first * factor.hi + (first * factor.lo + (log.hi - first + log.lo) * (factor.hi + factor.lo));
}

double power_of_two(int k) { return from_bits(static_cast<std::uint64_t>(0x3ff + k) << 52); }

double exp_m1(double x) {
  constexpr Sum kLn2{6.93147180369123816490e-01, 1.90821492927058770002e-10};
  const std::uint32_t top = high_word(x) & kNoSign;
  if (x != x || top < 0x3c900000) return x;  // 2^-54
  if (x > 7.09782712893383973096e+02) return std::numeric_limits<double>::infinity();
  if (x < 0.0 && top >= 0x4043687A) return -1.0;  // 56 ln2
  // x = k ln2 + y; c is the rounding error of y
  int k = 0;
  double c = 0.0;
  double y = x;
  if (top > 0x3fd62e42) {  // ln2 / 2
    if (top < 0x3FF0A2B2)  // 3/2 ln2
      k = x < 0.0 ? -1 : 1;
    else
      k = static_cast<int>(1.44269504088896338700e+00 * x + (x < 0.0 ? -0.5 : 0.5));
    const double hi = x - k * kLn2.hi;
    const double lo = k * kLn2.lo;
    y = hi - lo;
    c = (hi - y) - lo;
  }
  const double half = 0.5 * y;
  const double square = y * half;
  const double r = 1.0 + square * (-3.33333333333331316428e-02 +
                                   square * (1.58730158725481460165e-03 +
                                             square * (-7.93650757867487942473e-05 +
                                                       square * (4.00821782732936239552e-06 +
                                                                 square * -2.01099218183624371326e-07))));
  const double t = 3.0 - r * half;
  double e = square * ((r - t) / (6.0 - y * t));
  if (k == 0) return y - (y * e - square);
  e = y * (e - c) - c;
  e -= square;
  if (k == -1) return 0.5 * (y - e) - 0.5;
  if (k == 1) return y < -0.25 ? -2.0 * (e - (y + 0.5)) : 1.0 + 2.0 * (y - e);
  if (k == 1024) return (y - e + 1.0) * 2.0 * 0x1p1023 - 1.0;
  if (k < 0 || k > 56) return (y - e + 1.0) * power_of_two(k) - 1.0;
  const double inverse = power_of_two(-k);
  return (k < 20 ? y - e + (1.0 - inverse) : y - (e + inverse) + 1.0) * power_of_two(k);
}

}  // namespace

extern "C" {

double exp(double x) noexcept { return exp_of(x, 0.0, 0); }

double pow(double x, double y) noexcept {
  if (special(x) || special(y)) return pow_of_special(x, y);
  std::uint64_t negative = 0;
  if (x < 0.0) {
    const Parity is = whole(y);
    if (is == Parity::no) return kNan;
    if (is == Parity::odd) negative = kMinus;
    x = -x;
  }
  const std::uint32_t range = top12(y) & 0x7ff;
  if (range < 0x3be) return x > 1.0 ? 1.0 + y : 1.0 - y;                            // |y| < 2^-65
  if (range >= 0x43e) return x == 1.0 ? 1.0 : (x > 1.0) == (y > 0.0) ? kInf : 0.0;  // |y| >= 2^63
  const Sum log = long_log(normal_bits(x));
  // y log(x) as a sum: products of numbers with half as many bits are exact.
  const double y_hi = from_bits(bits_of(y) & -1ULL << 27);
  const double log_hi = from_bits(bits_of(log.hi) & -1ULL << 27);
  return exp_of(y_hi * log_hi, (y - y_hi) * log_hi + y * (log.hi - log_hi + log.lo), negative);
}

double log2(double x) noexcept { return log_times(x, {0x1.7154760000000p+0, 0x1.4ae0bf85ddf44p-26}); }
double log10(double x) noexcept { return log_times(x, {0x1.bcb7b10000000p-2, 0x1.49b9438ca9aaep-28}); }

double expm1(double x) noexcept { return exp_m1(x); }

double tanh(double x) noexcept {
  const std::uint32_t top = high_word(x) & kNoSign;
  if (x != x || top < 0x00100000) return x;
  const double a = std::fabs(x);
  double y = 1.0;
  if (top > 0x3fe193ea) {                                            // log(3) / 2
    if (top <= 0x40340000) y = 1.0 - 2.0 / (exp_m1(2.0 * a) + 2.0);  // 20
  } else if (top > 0x3fd058ae) {                                     // log(5/3) / 2
    const double t = exp_m1(2.0 * a);
    y = t / (t + 2.0);
  } else {
    const double t = exp_m1(-2.0 * a);
    y = -t / (t + 2.0);
  }
  return std::copysign(y, x);
}

}  // extern "C"
}  // namespace enc::math
