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

// x modulo pi/2. Up to 2^20 pi/2 after FreeBSD's e_rem_pio2.c (by way of musl 1.2.3), beyond that with whole
// numbers.
/*
 * ====================================================
 * Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
 *
 * Developed at SunSoft, a Sun Microsystems, Inc. business.
 * Permission to use, copy, modify, and distribute this
 * software is freely granted, provided that this notice
 * is preserved.
 * ====================================================
 *
 * Optimized by Bruce D. Evans.
 */

// x = quadrant pi/2 + rest, |rest| <= pi/4; only the quadrant's last two bits matter.
struct Reduction {
  Sum rest;
  unsigned quadrant;
};

__extension__ using UInt128 = unsigned __int128;
__extension__ using Int128 = __int128;

constexpr double kRound = 0x1.8p52;  // adding and subtracting it rounds to a whole number
constexpr double kTwoByPi = 6.36619772367581382433e-01;
// pi/2 in pieces of 33 bits, so that n times a piece is exact; and the remainder after each piece.
constexpr double kPiece[] = {1.57079632673412561417e+00, 6.07710050630396597660e-11,
                             2.02226624871116645580e-21};
constexpr double kLeft[] = {6.07710050650619224932e-11, 2.02226624879595063154e-21,
                            8.47842766036889956997e-32};

// The bits of 2/pi; the first one is worth a half.
constexpr std::uint64_t kTwoByPiBits[] = {
    0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, 0xfe5163abdebbc561, 0xb7246e3a424dd2e0,
    0x06492eea09d1921c, 0xfe1deb1cb129a73e, 0xe88235f52ebb4484, 0xe99c7026b45f7e41, 0x3991d639835339f4,
    0x9c845f8bbdf9283b, 0x1ff897ffde05980f, 0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7, 0x4f463f669e5fea2d,
    0x7527bac7ebe5f17b, 0x3d0739f78a5292ea, 0x6bfb5fb11f8d5d08, 0x56033046fc7b6bab, 0xf0cfbc209af4361d};

// 64 bits of 2/pi from bit `at` on; bits before the first are zero.
std::uint64_t two_by_pi_from(int at) {
  const auto get = [](int i) { return i < 0 ? 0 : kTwoByPiBits[i]; };
  if (at < 0) return get(0) >> -at;
  const int i = at / 64, shift = at % 64;
  return shift == 0 ? get(i) : get(i) << shift | get(i + 1) >> (64 - shift);
}

// x = m 2^e with whole m. The bits of 2/pi above 2^(2-e) make whole turns and are left out. The next 192 bits
// are multiplied by m modulo whole turns; 139 of them are right, and at most 62 of these cancel.
Reduction reduce_large(double x) {
  const std::uint64_t bits = bits_of(x);
  const std::uint64_t m = (bits & 0xfffffffffffff) | 0x10000000000000;
  const int e = static_cast<int>((bits >> 52) & 0x7ff) - 1075;
  // First bit of the window: worth 2^(1-e) of 2/pi, so 2 quadrants after multiplying.
  const int first = e - 2;
  const auto word = [&](int k) { return two_by_pi_from(first + 64 * k); };
  const UInt128 low = UInt128{m} * word(2);
  const UInt128 middle = UInt128{m} * word(1) + static_cast<std::uint64_t>(low >> 64);
  UInt128 top = (UInt128{m * word(0)} << 64) + middle;  // its first two bits are the quadrant
  std::uint64_t last = static_cast<std::uint64_t>(low);
  unsigned quadrant = static_cast<unsigned>(top >> 126);
  top = top << 2 | last >> 62;
  last <<= 2;
  const bool above = (top >> 127) != 0;  // more than half a quadrant: one quadrant more, less the rest
  if (above) {
    ++quadrant;
    top = ~top;
    last = ~last;
  }
  int zeros = 0;
  for (; (top >> 127) == 0 && zeros < 128; ++zeros) {
    top = top << 1 | last >> 63;
    last <<= 1;
  }
  // Multiply by pi/2, also as a whole number: the rest is product 2^(-127 - zeros).
  constexpr std::uint64_t kHalfPi = 0xc90fdaa22168c235;
  const UInt128 product = (top >> 64) * kHalfPi + (static_cast<std::uint64_t>(top) * UInt128{kHalfPi} >> 64);
  const double hi = static_cast<double>(product);
  const double lo = static_cast<double>(static_cast<Int128>(product - static_cast<UInt128>(hi)));
  const bool minus = (bits >> 63) != 0;
  const double scale =
      from_bits(static_cast<std::uint64_t>(1023 - 127 - zeros) << 52) * (above != minus ? -1.0 : 1.0);
  return {{hi * scale, lo * scale}, minus ? 0U - quadrant : quadrant};
}

Reduction reduce(double x) {
  const std::uint32_t top = high_word(x) & kNoSign;
  if (top >= kInfinite) return {{x - x, x - x}, 0};
  if (top >= 0x413921fb) return reduce_large(x);  // 2^20 pi/2
  const double n = x * kTwoByPi + kRound - kRound;
  double r = x - n * kPiece[0];
  double w = n * kLeft[0];
  double y = r - w;
  // The more bits cancel, the more bits of pi are needed: 85, 118, 151. The last suffices for every double.
  const auto lost = [&] {
    return static_cast<int>(top >> 20) - static_cast<int>((high_word(y) >> 20) & 0x7ff);
  };
  for (int k = 1; k < 3 && lost() > (k == 1 ? 16 : 49); ++k) {
    const double before = r;
    w = n * kPiece[k];
    r = before - w;
    w = n * kLeft[k] - ((before - r) - w);
    y = r - w;
  }
  return {{y, (r - y) - w}, static_cast<unsigned>(static_cast<int>(n))};
}

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

// tan(x), or -1 / tan(x) if odd.
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

double sine_of(const Reduction& x, unsigned turned) {
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
  const Reduction reduced = reduce(x);
  *sine = sine_of(reduced, 0);
  *cosine = sine_of(reduced, 1);
}

double tan(double x) noexcept {
  if (is_small(x)) return is_tiny(x) ? x : kernel_tan({x, 0.0}, false);
  const Reduction reduced = reduce(x);
  return kernel_tan(reduced.rest, (reduced.quadrant & 1) != 0);
}

}  // extern "C"
}  // namespace enc::math
