// expm1 and tanh. After FreeBSD's s_expm1.c (by way of musl 1.2.3) and musl's tanh.c (MIT, Rich Felker and
// others).
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

double power_of_two(int k) { return from_bits(static_cast<std::uint64_t>(0x3ff + k) << 52); }

}  // namespace

double exp_m1(double x) {
  constexpr Sum kLn2{6.93147180369123816490e-01, 1.90821492927058770002e-10};
  const std::uint32_t top = high_word(x) & kNoSign;
  if (x != x || top < 0x3c900000) return x;  // 2^-54
  if (x > 7.09782712893383973096e+02) return std::numeric_limits<double>::infinity();
  if (x < 0.0 && top >= 0x4043687A) return -1.0;  // 56 ln2
  // x = k ln2 + y, and c what rounding took of y
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

extern "C" {

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
