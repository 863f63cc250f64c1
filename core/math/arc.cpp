// asin, acos, atan, atan2. After FreeBSD's e_asin.c, e_acos.c, s_atan.c, e_atan2.c (by way of musl 1.2.3).
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

#include "core/math/bits.h"

namespace enc::math {
namespace {

constexpr Sum kPi{3.1415926535897931160E+00, 1.2246467991473531772E-16};
constexpr Sum kHalfPi{1.57079632679489655800e+00, 6.12323399573676603587e-17};
constexpr std::uint32_t kOne = 0x3ff00000, kHalf = 0x3fe00000;  // high words

// (asin(x) - x) / x as a function of z = x^2, up to x = 0.5
double ratio(double z) {
  const double p = z * (1.66666666666666657415e-01 +
                        z * (-3.25565818622400915405e-01 +
                             z * (2.01212532134862925881e-01 +
                                  z * (-4.00555345006794114027e-02 +
                                       z * (7.91534994289814532176e-04 + z * 3.47933107596021167570e-05)))));
  const double q = 1.0 + z * (-2.40339491173441421878e+00 +
                              z * (2.02094576023350569471e+00 +
                                   z * (-6.88283971605453293030e-01 + z * 7.70381505559019352791e-02)));
  return p / q;
}

// Value of asin and acos for |x| >= 1; `at`: the value at |x| = 1.
double at_the_end(double x, double at) { return std::fabs(x) == 1.0 ? at : (x - x) / (x - x); }

double arc_tangent(double x) {
  constexpr Sum kAtan[] = {{4.63647609000806093515e-01, 2.26987774529616870924e-17},   // of 0.5
                           {7.85398163397448278999e-01, 3.06161699786838301793e-17},   // of 1
                           {9.82793723247329054082e-01, 1.39033110312309984516e-17},   // of 1.5
                           {1.57079632679489655800e+00, 6.12323399573676603587e-17}};  // of infinity
  constexpr double T[] = {
      3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
      -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
      6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
      -3.65315727442169155270e-02, 1.62858201153657823623e-02};
  const std::uint32_t top = high_word(x) & kNoSign;
  if (x != x) return x;
  if (top >= 0x44100000) return std::copysign(kAtan[3].hi, x);  // 2^66
  if (top < 0x3e400000) return x;                               // 2^-27
  const double a = std::fabs(x);
  int near = -1;
  double y = x;
  if (top >= 0x40038000) {  // 2.4375
    near = 3;
    y = -1.0 / a;
  } else if (top >= 0x3ff30000) {  // 1.1875
    near = 2;
    y = (a - 1.5) / (1.0 + 1.5 * a);
  } else if (top >= 0x3fe60000) {  // 0.6875
    near = 1;
    y = (a - 1.0) / (a + 1.0);
  } else if (top >= 0x3fdc0000) {  // 0.4375
    near = 0;
    y = (2.0 * a - 1.0) / (2.0 + a);
  }
  const double z = y * y;
  const double w = z * z;
  const double s = z * (T[0] + w * (T[2] + w * (T[4] + w * (T[6] + w * (T[8] + w * T[10])))));
  const double t = w * (T[1] + w * (T[3] + w * (T[5] + w * (T[7] + w * T[9]))));
  if (near < 0) return y - y * (s + t);
  return std::copysign(kAtan[near].hi - (y * (s + t) - kAtan[near].lo - y), x);
}

}  // namespace

extern "C" {

double atan(double x) noexcept { return arc_tangent(x); }

double atan2(double y, double x) noexcept {
  if (x != x || y != y) return x + y;
  const double a = std::fabs(x), b = std::fabs(y);
  const bool back = std::signbit(x);
  if (b == 0.0) return back ? std::copysign(kPi.hi, y) : y;
  const auto binary = [](double v) { return static_cast<int>((high_word(v) & kNoSign) >> 20); };
  const int higher = binary(y) - binary(x);
  double z = 0.0;
  if (std::isinf(a) && std::isinf(b)) return std::copysign(back ? 3.0 * kPi.hi / 4.0 : kPi.hi / 4.0, y);
  if (a == 0.0 || higher > 64 || std::isinf(b)) return std::copysign(kHalfPi.hi, y);
  if (std::isinf(a))
    z = 0.0;
  else if (!back || higher >= -64)
    z = arc_tangent(b / a);
  return std::copysign(back ? kPi.hi - (z - kPi.lo) : z, y);
}

double asin(double x) noexcept {
  const std::uint32_t top = high_word(x) & kNoSign;
  if (top >= kOne) return at_the_end(x, std::copysign(kHalfPi.hi, x));
  if (top < 0x3e500000) return x;  // 2^-26
  if (top < kHalf) return x + x * ratio(x * x);
  const double z = (1.0 - std::fabs(x)) * 0.5;
  const double s = std::sqrt(z);
  const double r = ratio(z);
  if (top >= 0x3fef3333)  // 0.975
    return std::copysign(kHalfPi.hi - (2.0 * (s + s * r) - kHalfPi.lo), x);
  const double f = short_of(s);
  const double c = (z - f * f) / (s + f);
  return std::copysign(
      0.5 * kHalfPi.hi - (2.0 * s * r - (kHalfPi.lo - 2.0 * c) - (0.5 * kHalfPi.hi - 2.0 * f)), x);
}

double acos(double x) noexcept {
  const std::uint32_t top = high_word(x) & kNoSign;
  if (top >= kOne) return at_the_end(x, x > 0.0 ? 0.0 : kPi.hi);
  if (top <= 0x3c600000) return kHalfPi.hi;  // 2^-57
  if (top < kHalf) return kHalfPi.hi - (x - (kHalfPi.lo - x * ratio(x * x)));
  const double z = (1.0 - std::fabs(x)) * 0.5;
  const double s = std::sqrt(z);
  if (std::signbit(x)) return 2.0 * (kHalfPi.hi - (s + (ratio(z) * s - kHalfPi.lo)));
  const double f = short_of(s);
  const double c = (z - f * f) / (s + f);
  return 2.0 * (f + (ratio(z) * s + c));
}

}  // extern "C"
}  // namespace enc::math
