// sin, cos, tan: polynomials in the eighth of a turn next to zero. After FreeBSD's k_sin.c, k_cos.c, k_tan.c,
// s_sin.c (by way of musl 1.2.3).
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

constexpr std::uint32_t kEighth = 0x3fe921fb;  // high word of pi/4

double kernel_sin(Sum x) {
  constexpr double S1 = -1.66666666666666324348e-01, S2 = 8.33333333332248946124e-03,
                   S3 = -1.98412698298579493134e-04, S4 = 2.75573137070700676789e-06,
                   S5 = -2.50507602534068634195e-08, S6 = 1.58969099521155010221e-10;
  const double z = x.hi * x.hi;
  const double w = z * z;
  const double r = S2 + z * (S3 + z * S4) + z * w * (S5 + z * S6);
  const double v = z * x.hi;
  return x.hi - ((z * (0.5 * x.lo - v * r) - x.lo) - v * S1);
}

double kernel_cos(Sum x) {
  constexpr double C1 = 4.16666666666666019037e-02, C2 = -1.38888888888741095749e-03,
                   C3 = 2.48015872894767294178e-05, C4 = -2.75573143513906633035e-07,
                   C5 = 2.08757232129817482790e-09, C6 = -1.13596475577881948265e-11;
  const double z = x.hi * x.hi;
  const double w = z * z;
  const double r = z * (C1 + z * (C2 + z * C3)) + w * w * (C4 + z * (C5 + z * C6));
  const double half = 0.5 * z;
  const double one = 1.0 - half;
  return one + (((1.0 - one) - half) + (z * r - x.hi * x.lo));
}

// tan(x), or where odd -1 / tan(x).
double kernel_tan(Sum a, bool odd) {
  constexpr double T[] = {3.33333333333334091986e-01, 1.33333333333201242699e-01, 5.39682539762260521377e-02,
                          2.18694882948595424599e-02, 8.86323982359930005737e-03, 3.59207910759131235356e-03,
                          1.45620945432529025516e-03, 5.88041240820264096874e-04, 2.46463134818469906812e-04,
                          7.81794442939557092300e-05, 7.14072491382608190305e-05, -1.85586374855275456654e-05,
                          2.59073051863633712884e-05};
  constexpr Sum kPiBy4{7.85398163397448278999e-01, 3.06161699786838301793e-17};
  double x = a.hi, y = a.lo;
  const bool big = (high_word(x) & kNoSign) >= 0x3FE59428;  // 0.6744
  const bool minus = (high_word(x) >> 31) != 0;
  if (big) {
    x = (kPiBy4.hi - std::fabs(x)) + (kPiBy4.lo - (minus ? -y : y));
    y = 0.0;
  }
  const double z = x * x;
  const double z2 = z * z;
  const double r0 = T[1] + z2 * (T[3] + z2 * (T[5] + z2 * (T[7] + z2 * (T[9] + z2 * T[11]))));
  const double v0 = z * (T[2] + z2 * (T[4] + z2 * (T[6] + z2 * (T[8] + z2 * (T[10] + z2 * T[12])))));
  const double s = z * x;
  const double r = y + z * (s * (r0 + v0) + y) + s * T[0];
  const double w = x + r;
  if (big) {
    const double one = odd ? -1.0 : 1.0;
    const double v = one - 2.0 * (x + (r - w * w / (w + one)));
    return minus ? -v : v;
  }
  if (!odd) return w;
  // -1 / (x + r), in two pieces
  const double w0 = short_of(w);
  const double v = r - (w0 - x);
  const double q = -1.0 / w;
  const double q0 = short_of(q);
  return q0 + q * (1.0 + q0 * w0 + q0 * v);
}

double sine_of(const Reduced& x, unsigned turned) {
  const unsigned quadrant = x.quadrant + turned;
  const double y = (quadrant & 1) != 0 ? kernel_cos(x.rest) : kernel_sin(x.rest);
  return (quadrant & 2) != 0 ? -y : y;
}

bool is_small(double x) { return (high_word(x) & kNoSign) <= kEighth; }
bool is_tiny(double x) { return (high_word(x) & kNoSign) < 0x3e400000; }  // 2^-27

}  // namespace

extern "C" {

double sin(double x) noexcept {
  if (!is_small(x)) return sine_of(reduce(x), 0);
  return is_tiny(x) ? x : kernel_sin({x, 0.0});
}

double cos(double x) noexcept { return is_small(x) ? kernel_cos({x, 0.0}) : sine_of(reduce(x), 1); }

void sincos(double x, double* sine, double* cosine) noexcept {
  if (is_small(x)) {
    *sine = is_tiny(x) ? x : kernel_sin({x, 0.0});
    *cosine = kernel_cos({x, 0.0});
    return;
  }
  const Reduced reduced = reduce(x);
  *sine = sine_of(reduced, 0);
  *cosine = sine_of(reduced, 1);
}

double tan(double x) noexcept {
  if (is_small(x)) return is_tiny(x) ? x : kernel_tan({x, 0.0}, false);
  const Reduced reduced = reduce(x);
  return kernel_tan(reduced.rest, (reduced.quadrant & 1) != 0);
}

}  // extern "C"
}  // namespace enc::math
