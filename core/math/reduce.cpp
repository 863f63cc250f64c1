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
#include "core/math/bits.h"

namespace enc::math {
namespace {

__extension__ using Wide = unsigned __int128;
__extension__ using SignedWide = __int128;

constexpr double kRound = 0x1.8p52;  // added and taken away again: the nearest whole number
constexpr double kTwoByPi = 6.36619772367581382433e-01;
// pi/2 in pieces of 33 bits, so that n times a piece is exact; and after each piece what is left.
constexpr double kPiece[] = {1.57079632673412561417e+00, 6.07710050630396597660e-11,
                             2.02226624871116645580e-21};
constexpr double kLeft[] = {6.07710050650619224932e-11, 2.02226624879595063154e-21,
                            8.47842766036889956997e-32};

// The bits of 2/pi, the first of them worth a half.
constexpr std::uint64_t kTwoByPiBits[] = {
    0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, 0xfe5163abdebbc561, 0xb7246e3a424dd2e0,
    0x06492eea09d1921c, 0xfe1deb1cb129a73e, 0xe88235f52ebb4484, 0xe99c7026b45f7e41, 0x3991d639835339f4,
    0x9c845f8bbdf9283b, 0x1ff897ffde05980f, 0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7, 0x4f463f669e5fea2d,
    0x7527bac7ebe5f17b, 0x3d0739f78a5292ea, 0x6bfb5fb11f8d5d08, 0x56033046fc7b6bab, 0xf0cfbc209af4361d};

// 64 bits of 2/pi from bit `at` on; before the first there are zeros.
std::uint64_t two_by_pi_from(int at) {
  const auto get = [](int i) { return i < 0 ? 0 : kTwoByPiBits[i]; };
  if (at < 0) return get(0) >> -at;
  const int i = at / 64, shift = at % 64;
  return shift == 0 ? get(i) : get(i) << shift | get(i + 1) >> (64 - shift);
}

// x = m 2^e with whole m. The bits of 2/pi above 2^(2-e) make whole turns and are left out; of the next 192,
// which are multiplied by m modulo whole turns, 139 are right, and at most 62 of these cancel.
Reduced reduce_large(double x) {
  const std::uint64_t bits = bits_of(x);
  const std::uint64_t m = (bits & 0xfffffffffffff) | 0x10000000000000;
  const int e = static_cast<int>((bits >> 52) & 0x7ff) - 1075;
  // First bit of the window: worth 2^(1-e) of 2/pi, so 2 quadrants after multiplying.
  const int first = e - 2;
  const auto word = [&](int k) { return two_by_pi_from(first + 64 * k); };
  const Wide low = Wide{m} * word(2);
  const Wide middle = Wide{m} * word(1) + static_cast<std::uint64_t>(low >> 64);
  Wide top = (Wide{m * word(0)} << 64) + middle;  // its first two bits are the quadrant
  std::uint64_t last = static_cast<std::uint64_t>(low);
  unsigned quadrant = static_cast<unsigned>(top >> 126);
  top = top << 2 | last >> 62;
  last <<= 2;
  const bool above = (top >> 127) != 0;  // more than half a quadrant: it is one more, less the rest
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
  // Times pi/2, as a whole number again: the rest is product 2^(-127 - zeros).
  constexpr std::uint64_t kHalfPi = 0xc90fdaa22168c235;
  const Wide product = (top >> 64) * kHalfPi + (static_cast<std::uint64_t>(top) * Wide{kHalfPi} >> 64);
  const double hi = static_cast<double>(product);
  const double lo = static_cast<double>(static_cast<SignedWide>(product - static_cast<Wide>(hi)));
  const bool minus = (bits >> 63) != 0;
  const double scale =
      from_bits(static_cast<std::uint64_t>(1023 - 127 - zeros) << 52) * (above != minus ? -1.0 : 1.0);
  return {{hi * scale, lo * scale}, minus ? 0U - quadrant : quadrant};
}

}  // namespace

Reduced reduce(double x) {
  const std::uint32_t top = high_word(x) & kNoSign;
  if (top >= kInfinite) return {{x - x, x - x}, 0};
  if (top >= 0x413921fb) return reduce_large(x);  // 2^20 pi/2
  const double n = x * kTwoByPi + kRound - kRound;
  double r = x - n * kPiece[0];
  double w = n * kLeft[0];
  double y = r - w;
  // The more bits cancel, the more of pi is needed: 85, 118, 151 bits; the last does for every double.
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

}  // namespace enc::math
