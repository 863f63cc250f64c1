// cbrt, hypot, and exp and the absolute value of a complex number. After FreeBSD's s_cbrt.c (by way of musl
// 1.2.3) and musl's hypot.c (MIT, Rich Felker and others).
/*
 * ====================================================
 * Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
 *
 * Developed at SunPro, a Sun Microsystems, Inc. business.
 * Permission to use, copy, modify, and distribute this
 * software is freely granted, provided that this notice
 * is preserved.
 * ====================================================
 *
 * Optimized by Bruce D. Evans.
 */
#include <cmath>
#include <utility>

#include "core/math/bits.h"

namespace enc::math {
namespace {

__extension__ using Complex = _Complex double;

// x^2 as a sum
Sum square(double x) {
  const double shift = x * (0x1p27 + 1);
  const double hi = x - shift + shift;
  const double lo = x - hi;
  const double y = x * x;
  return {y, hi * hi - y + 2.0 * hi * lo + lo * lo};
}

double length(double a, double b) {
  double x = std::fabs(a), y = std::fabs(b);
  if (std::isinf(x) || std::isinf(y)) return HUGE_VAL;
  if (x != x || y != y) return x + y;
  if (x < y) std::swap(x, y);
  const int high = static_cast<int>(bits_of(x) >> 52), low = static_cast<int>(bits_of(y) >> 52);
  if (y == 0.0 || high - low > 64) return x + y;
  double scale = 1.0;
  if (high > 0x3ff + 510) {
    scale = 0x1p700;
    x *= 0x1p-700;
    y *= 0x1p-700;
  } else if (low < 0x3ff - 450) {
    scale = 0x1p-700;
    x *= 0x1p700;
    y *= 0x1p700;
  }
  const Sum x2 = square(x), y2 = square(y);
  return scale * std::sqrt(y2.lo + x2.lo + y2.hi + x2.hi);
}

}  // namespace

extern "C" {

double cbrt(double x) noexcept {
  std::uint32_t top = high_word(x) & kNoSign;
  if (top >= kInfinite || x == 0.0) return x;
  if (top >= 0x00100000)
    top = top / 3 + 715094163;
  else
    top = (high_word(x * 0x1p54) & kNoSign) / 3 + 696219795;
  // accurate to 5 bits, then 23, then (Newton) all
  double t = std::copysign(from_bits(static_cast<std::uint64_t>(top) << 32), x);
  const double r = (t * t) * (t / x);
  t = t * ((1.87595182427177009643 + r * (-1.88497979543377169875 + r * 1.621429720105354466140)) +
           ((r * r) * r) * (-0.758397934778766047437 + r * 0.145996192886612446982));
  t = from_bits((bits_of(t) + 0x80000000) & 0xffffffffc0000000);
  const double q = x / (t * t);
  return t + t * ((q - t) / (t + t + q));
}

double hypot(double x, double y) noexcept { return length(x, y); }

double cabs(Complex z) noexcept { return length(__real__ z, __imag__ z); }

Complex cexp(Complex z) noexcept {
  const double size = std::exp(__real__ z), angle = __imag__ z;
  if (angle == 0.0) return Complex{size, angle};
  return Complex{size * std::cos(angle), size * std::sin(angle)};
}

}  // extern "C"
}  // namespace enc::math
