// erf, as quotients of polynomials. After FreeBSD's s_erf.c (by way of musl 1.2.3).
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

// c[0] + c[1] x + c[2] x^2 ...
template <int N>
double polynomial(const double (&c)[N], double x) {
  double y = c[N - 1];
  for (int i = N - 2; i >= 0; --i) y = c[i] + x * y;
  return y;
}

double quotient_near_zero(double z) {
  constexpr double P[] = {1.28379167095512558561e-01, -3.25042107247001499370e-01,
                          -2.84817495755985104766e-02, -5.77027029648944159157e-03,
                          -2.37630166566501626084e-05};
  constexpr double Q[] = {1.0,
                          3.97917223959155352819e-01,
                          6.50222499887672944485e-02,
                          5.08130628187576562776e-03,
                          1.32494738004321644526e-04,
                          -3.96022827877536812320e-06};
  return polynomial(P, z) / polynomial(Q, z);
}

// 0.84 <= x < 1.25, of x - 1.
double quotient_near_one(double z) {
  constexpr double P[] = {-2.36211856075265944077e-03, 4.14856118683748331666e-01,
                          -3.72207876035701323847e-01, 3.18346619901161753674e-01,
                          -1.10894694282396677476e-01, 3.54783043256182359371e-02,
                          -2.16637559486879084300e-03};
  constexpr double Q[] = {1.0,
                          1.06420880400844228286e-01,
                          5.40397917702171048937e-01,
                          7.18286544141962662868e-02,
                          1.26171219808761642112e-01,
                          1.36370839120290507362e-02,
                          1.19844998467991074170e-02};
  return polynomial(P, z) / polynomial(Q, z);
}

// 1.25 <= x < 1 / 0.35, of 1 / x^2.
double quotient_to_three(double s) {
  constexpr double P[] = {-9.86494403484714822705e-03, -6.93858572707181764372e-01,
                          -1.05586262253232909814e+01, -6.23753324503260060396e+01,
                          -1.62396669462573470355e+02, -1.84605092906711035994e+02,
                          -8.12874355063065934246e+01, -9.81432934416914548592e+00};
  constexpr double Q[] = {1.0,
                          1.96512716674392571292e+01,
                          1.37657754143519042600e+02,
                          4.34565877475229228821e+02,
                          6.45387271733267880336e+02,
                          4.29008140027567833386e+02,
                          1.08635005541779435134e+02,
                          6.57024977031928170135e+00,
                          -6.04244152148580987438e-02};
  return polynomial(P, s) / polynomial(Q, s);
}

// 1 / 0.35 <= x < 6, of 1 / x^2.
double quotient_to_six(double s) {
  constexpr double P[] = {-9.86494292470009928597e-03, -7.99283237680523006574e-01,
                          -1.77579549177547519889e+01, -1.60636384855821916062e+02,
                          -6.37566443368389627722e+02, -1.02509513161107724954e+03,
                          -4.83519191608651397019e+02};
  constexpr double Q[] = {1.0,
                          3.03380607434824582924e+01,
                          3.25792512996573918826e+02,
                          1.53672958608443695994e+03,
                          3.19985821950859553908e+03,
                          2.55305040643316442583e+03,
                          4.74528541206955367215e+02,
                          -2.24409524465858183362e+01};
  return polynomial(P, s) / polynomial(Q, s);
}

// 1 - erf(x), 0.84 <= x < 6
double complement(double x) {
  if (x < 1.25) return 1.0 - 8.45062911510467529297e-01 - quotient_near_one(x - 1.0);
  const double s = 1.0 / (x * x);
  const double quotient = x < 1.0 / 0.35 ? quotient_to_three(s) : quotient_to_six(s);
  const double z = short_of(x);
  return std::exp(-z * z - 0.5625) * std::exp((z - x) * (z + x) + quotient) / x;
}

}  // namespace

extern "C" double erf(double x) noexcept {
  const double a = std::fabs(x);
  if (x != x) return x;
  if (a < 0x1p-28) return 0.125 * (8.0 * x + 1.02703333676410069053e+00 * x);
  if (a < 0.84375) return x + x * quotient_near_zero(x * x);
  return std::copysign(a < 6.0 ? 1.0 - complement(a) : 1.0, x);
}

}  // namespace enc::math
