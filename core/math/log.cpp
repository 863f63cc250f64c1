// log, after log.c of ARM's optimized routines; log1p after FreeBSD's s_log1p.c (both by way of musl 1.2.3).
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

// log(1 + r) near zero
double log_near_one(double r) {
  constexpr double B[] = {-0x1p-1,
                          0x1.5555555555577p-2,
                          -0x1.ffffffffffdcbp-3,
                          0x1.999999995dd0cp-3,
                          -0x1.55555556745a7p-3,
                          0x1.24924a344de3p-3,
                          -0x1.fffffa4423d65p-4,
                          0x1.c7184282ad6cap-4,
                          -0x1.999eb43b068ffp-4,
                          0x1.78182f7afd085p-4,
                          -0x1.5521375d145cdp-4};
  const double r2 = r * r;
  const double r3 = r * r2;
  const double y =
      r3 * (B[1] + r * B[2] + r2 * B[3] +
            r3 * (B[4] + r * B[5] + r2 * B[6] + r3 * (B[7] + r * B[8] + r2 * B[9] + r3 * B[10])));
  const double shift = r * 0x1p27;
  const double r_hi = r + shift - shift;
  const double r_lo = r - r_hi;
  const double w = r_hi * r_hi * B[0];
  const double hi = r + w;
  double lo = r - hi + w;
  lo += B[0] * r_lo * (r_hi + r);
  return y + lo + hi;
}

}  // namespace

extern "C" {

double log(double x) noexcept {
  std::uint64_t bits = bits_of(x);
  constexpr std::uint64_t kLow = std::bit_cast<std::uint64_t>(1.0 - 0x1p-4);
  constexpr std::uint64_t kHigh = std::bit_cast<std::uint64_t>(1.0 + 0x1.09p-4);
  if (bits - kLow < kHigh - kLow) return log_near_one(x - 1.0);
  const std::uint32_t top = static_cast<std::uint32_t>(bits >> 52);
  if (top - 1 >= 0x7fe) {
    if (x == 0.0) return -kInf;
    if (x < 0.0) return kNan;
    if (top != 0) return x;
    bits = bits_of(x * 0x1p52) - (52ULL << 52);
  }
  // x = 2^k z, z = c (1 + r)
  const std::uint64_t from = bits - 0x3fe6000000000000;
  const LogRow& row = kLogTable[(from >> 45) % 128];
  const double k = static_cast<double>(static_cast<std::int64_t>(from) >> 52);
  const double z = from_bits(bits - (from & 0xfffULL << 52));
  const double r = (z - row.c - row.c_tail) * row.inverse;
  const double w = k * 0x1.62e42fefa3800p-1 + row.log;
  const double hi = w + r;
  const double lo = w - hi + r + k * 0x1.ef35793c76730p-45;
  const double r2 = r * r;
  return lo + r2 * -0x1.0000000000001p-1 +
         r * r2 *
             (0x1.555555551305bp-2 + r * -0x1.fffffffeb459p-3 +
              r2 * (0x1.999b324f10111p-3 + r * -0x1.55575e506c89fp-3)) +
         hi;
}

double log1p(double x) noexcept {
  const std::uint32_t top = high_word(x);
  if (x <= -1.0) return x == -1.0 ? -kInf : kNan;
  if ((top & kNoSign) >= kInfinite || (top & kNoSign) < 0x3ca00000) return x;  // or below 2^-53
  // 1 + x = 2^k (1 + f); c is the rounding error of 1 + x
  double f = x, c = 0.0, k = 0.0;
  const bool near = x < 0.0 ? top <= 0xbfd2bec4 : top < 0x3fda827a;  // sqrt(2)/2 - 1, sqrt(2) - 1
  if (!near) {
    const double y = 1.0 + x;
    const std::uint32_t moved = high_word(y) + (0x3ff00000 - 0x3fe6a09e);
    const int power = static_cast<int>(moved >> 20) - 0x3ff;
    if (power < 54) c = (power >= 2 ? 1.0 - (y - x) : x - (y - 1.0)) / y;
    const std::uint64_t high = (moved & 0x000fffff) + 0x3fe6a09e;
    f = from_bits(high << 32 | (bits_of(y) & 0xffffffff)) - 1.0;
    k = power;
  }
  const double half = 0.5 * f * f;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double even =
      w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double odd =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  return s * (half + (odd + even)) + (k * 1.90821492927058770002e-10 + c) - half + f +
         k * 6.93147180369123816490e-01;
}

}  // extern "C"
}  // namespace enc::math
