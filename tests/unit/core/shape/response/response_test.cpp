#include "core/shape/response/response.h"

#include <array>
#include <limits>
#include <string>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "tests/support/refusal.h"

namespace enc {
namespace {

using testing::AllOf, testing::HasSubstr;

constexpr double kFloor = 119.0;  // N/m

// Coefficients of d^1..d^4 in N/mm^k to SI.
std::array<double, 4> per_mm(std::array<double, 4> a) {
  double scale = 1.0;
  for (double& c : a) c *= (scale *= 1e3);
  return a;
}

// Straight lines: 2 N/mm pressing, 1 N/mm releasing, to 6 mm. gap(d) = 1000 d, largest 6 N; Y(d) = 500 d^2;
// L = 6 N * 1.5 mm = 9e-3 N m.
Response lines() {
  return {{.press = {2000.0, 0, 0, 0}, .release = {1000.0, 0, 0, 0}, .limit = 6e-3}, kFloor};
}

std::string refusal(const ResponseSpec& spec, double floor = kFloor) {
  return test::refusal([&] { const Response response(spec, floor); });
}

TEST(Response, FirstPressIsThePressCurve) {
  const Response r = lines();
  ResponseState s;
  EXPECT_NEAR(r.largest_gap(), 6.0, 1e-12);
  EXPECT_EQ(r.limit(), 6e-3);
  EXPECT_NEAR(r.force(s, 3e-3), 6.0, 1e-12);
  EXPECT_NEAR(r.force(s, 6e-3), 12.0, 1e-12);
  EXPECT_EQ(s.alpha, 1.0);
}

// Release from 6 to 5.9 mm: alpha = 1 - 500 (36 - 34.81) e-6 / 9e-3 = 0.9338889, F = 5.9 (1 + 0.9338889) N.
// To 5 mm: alpha = 1 - 500 * 11e-6 / 9e-3 = 0.3888889, F = 6.9444444 N. To 4 mm: 500 * 20e-6 > L, so alpha =
// 0 and F = 4 N.
TEST(Response, TurnsFromPressToReleaseAsByHand) {
  const Response r = lines();
  ResponseState s;
  r.force(s, 6e-3);
  EXPECT_NEAR(r.force(s, 5.9e-3), 11.4099444, 1e-7);
  EXPECT_NEAR(s.alpha, 0.9338889, 1e-7);
  EXPECT_NEAR(r.force(s, 5e-3), 6.9444444, 1e-7);
  EXPECT_NEAR(r.force(s, 4e-3), 4.0, 1e-12);
  EXPECT_EQ(s.alpha, 0.0);
}

// Released to 0.5 mm, pressed again to 1 mm: alpha = 500 (1 - 0.25) e-6 / 9e-3 = 0.0416667.
TEST(Response, TurnsFromReleaseToPressAsByHand) {
  const Response r = lines();
  ResponseState s;
  for (const double d : {6e-3, 0.5e-3}) r.force(s, d);
  EXPECT_NEAR(r.force(s, 1e-3), 1.0416667, 1e-7);
}

TEST(Response, RecoversAtZero) {
  const Response r = lines();
  ResponseState s;
  for (const double d : {6e-3, 1e-3}) r.force(s, d);
  EXPECT_EQ(s.alpha, 0.0);
  EXPECT_EQ(r.force(s, 0.0), 0.0);
  EXPECT_EQ(s.alpha, 1.0);
  EXPECT_NEAR(r.force(s, 1e-3), 2.0, 1e-12);
}

TEST(Response, StaysWithinItsLimits) {
  const Response r = lines();
  ResponseState s;
  EXPECT_NEAR(r.force(s, 7e-3), 12.0, 1e-12);
  EXPECT_EQ(s.deflection, 6e-3);
  EXPECT_EQ(r.deflection(s, 13.0), 6e-3);
  EXPECT_EQ(r.deflection(s, -1.0), 0.0);
  EXPECT_EQ(r.force(s, -1e-3), 0.0);
}

// F = 2 N/mm d at first, so 5 N is 2.5 mm; on the way back, once alpha is 0, F = 1 N/mm d, so 1 N is 1 mm.
TEST(Response, InverseAsByHand) {
  const Response r = lines();
  ResponseState s;
  EXPECT_NEAR(r.deflection(s, 5.0), 2.5e-3, 1e-12);
  r.deflection(s, 12.0);
  EXPECT_NEAR(r.deflection(s, 1.0), 1e-3, 1e-12);
}

TEST(Response, InverseUndoesForceAlongALoop) {
  const Response r({.press = per_mm({0.25, 1.14, -0.24, 0.0164}),
                    .release = per_mm({0.125, 0.89, -0.196, 0.0163}),
                    .limit = 6e-3},
                   kFloor);
  ResponseState there, back;
  for (const double mm : {0.2, 3.0, 5.9, 5.85, 5.0, 2.0, 2.1, 4.0, 6.0, 0.4, 0.0, 1.0}) {
    const double force = r.force(there, mm * 1e-3);
    EXPECT_NEAR(r.deflection(back, force), mm * 1e-3, 1e-12) << mm << " mm";
    EXPECT_NEAR(back.alpha, there.alpha, 1e-8) << mm << " mm";
  }
}

// Slope 0.1 (d - 1)(d - 2) N/mm, d in mm: negative between 1 and 2 mm. The check samples every 3 um.
TEST(Response, RefusesAFallingCurveAndNamesTheInterval) {
  const ResponseSpec spec{
      .press = per_mm({3.0, 0, 0, 0}), .release = per_mm({0.2, -0.15, 0.1 / 3.0, 0}), .limit = 6e-3};
  EXPECT_THAT(refusal(spec), AllOf(HasSubstr("release curve falls"), HasSubstr("from 1.002 to 1.998")));
}

// The unconstrained polynomials printed in sources/ball 5 (their constants left out): the release slope
// -0.6128 + 3.0338 d - 1.0848 d^2 + 0.1204 d^3 is 0 at 0.2187 mm (sources/ball 5).
TEST(Response, RefusesThePolynomialsPrintedForTheBall) {
  const ResponseSpec spec{.press = per_mm({0.3767, 1.0669, -0.2232, 0.0152}),
                          .release = per_mm({-0.6128, 1.5169, -0.3616, 0.0301}),
                          .limit = 6e-3};
  EXPECT_THAT(refusal(spec), AllOf(HasSubstr("release curve falls"), HasSubstr("from 0.000 to 0.216")));
}

TEST(Response, RefusesACurveSofterThanTheFloor) {
  const ResponseSpec spec{.press = {1000.0, 0, 0, 0}, .release = {100.0, 0, 0, 0}, .limit = 6e-3};
  EXPECT_THAT(refusal(spec), AllOf(HasSubstr("release curve is softer"), HasSubstr("0.119 N per millimetre"),
                                   HasSubstr("from 0.000 to 6.000")));
  EXPECT_EQ(refusal(spec, 100.0), "");
  // Press slope 0.1 + 0.2 d N/mm: below 0.119 up to 0.095 mm, seen at 0.093.
  const ResponseSpec begins{
      .press = per_mm({0.1, 0.1, 0, 0}), .release = per_mm({0.1, 0, 0, 0}), .limit = 6e-3};
  EXPECT_THAT(refusal(begins), AllOf(HasSubstr("press curve is softer"), HasSubstr("from 0.000 to 0.093")));
}

// press - release = 0.01 d (d - 2)(d - 4) N, d in mm: negative between 2 and 4 mm; both curves rise.
TEST(Response, RefusesReleaseAbovePress) {
  const ResponseSpec spec{
      .press = per_mm({2.0, 0, 0, 0}), .release = per_mm({1.92, 0.06, -0.01, 0}), .limit = 6e-3};
  EXPECT_THAT(refusal(spec),
              AllOf(HasSubstr("release curve is above the press curve"), HasSubstr("from 2.001 to 3.999")));
}

// A typo in the limit: 9e18 mm, more than a number of thousandths can hold.
TEST(Response, RefusesALimitThatNobodyMeansInWords) {
  const ResponseSpec spec{
      .press = per_mm({0.8, 4.0, 0, 0.05}), .release = per_mm({0.1, 3.4, 0, 0.06}), .limit = 9.2e15};
  EXPECT_THAT(refusal(spec, 10.0), AllOf(HasSubstr("release curve is above the press curve"),
                                         HasSubstr(" to 9.2e+18 (deflection in millimetres)")));
}

TEST(Response, RefusesWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const ResponseSpec good{.press = {2000.0, 0, 0, 0}, .release = {1000.0, 0, 0, 0}, .limit = 6e-3};
  EXPECT_EQ(refusal(good), "");
  for (const double bad : {kNan, kInf, -kInf}) {
    ResponseSpec spec = good;
    spec.press[2] = bad;
    EXPECT_THAT(refusal(spec), HasSubstr("finite"));
    spec = good;
    spec.release[0] = bad;
    EXPECT_THAT(refusal(spec), HasSubstr("finite"));
    spec = good;
    spec.limit = bad;
    EXPECT_THAT(refusal(spec), HasSubstr("limit"));
  }
  for (const double bad : {0.0, -6e-3}) {
    ResponseSpec spec = good;
    spec.limit = bad;
    EXPECT_THAT(refusal(spec), HasSubstr("limit"));
  }
}

// One curve for press and release: no gap, no loop, no storage to divide by.
TEST(Response, AnElasticObjectHasNoLoop) {
  const Response r({.press = {1000.0, 0, 0, 0}, .release = {1000.0, 0, 0, 0}, .limit = 6e-3}, kFloor);
  ResponseState s;
  EXPECT_EQ(r.largest_gap(), 0.0);
  for (const double d : {1e-3, 4e-3, 2e-3, 6e-3, 1e-3}) {
    EXPECT_NEAR(r.force(s, d), 1000.0 * d, 1e-12);
    EXPECT_NEAR(r.deflection(s, 500.0 * d), 0.5 * d, 1e-12);
  }
}

// The Prandtl-Ishlinskii model by hand: stops, force, inverse, refusals.

constexpr double kSoftest = 119.0;  // N/m

// Curve 12 u N, that is 2 N/mm to 6 mm; stops of 0.5 and 1 mm, 0.6 and 0.3 N/mm at 6 mm. The polynomials are
// not used, and one weight of zero stands between.
ResponseSpec spec() {
  ResponseSpec s;
  s.press = {2000.0, 0, 0, 0};
  s.release = {1000.0, 0, 0, 0};
  s.limit = 6e-3;
  s.stops = StopsSpec{{12.0}, {0.5e-3, 0.7e-3, 1e-3}, {600.0, 0.0, 300.0}};
  return s;
}
Response stops(const ResponseSpec& s = spec()) { return {s, kSoftest, Reversal::prandtl_ishlinskii}; }

std::string refused(const ResponseSpec& s, double floor = kSoftest) {
  return test::refusal([&] { const Response response(s, floor, Reversal::prandtl_ishlinskii); });
}

// Deflection 0.3 mm: both stops are stretched by 0.3 mm: 0.6 N + 0.05 * 0.9 * 0.3 N. 3 mm: both slide: 6 N +
// 0.5 (0.6 * 0.5 + 0.3 * 1) N = 6.3 N. 6 mm: 12.6 N.
TEST(Stops, FirstPressAsByHand) {
  const Response r = stops();
  ResponseState s;
  EXPECT_NEAR(r.force(s, 0.3e-3), 0.6135, 1e-12);
  EXPECT_NEAR(s.stop[0], 0.3e-3, 1e-18);
  EXPECT_NEAR(r.force(s, 3e-3), 6.3, 1e-12);
  EXPECT_NEAR(s.stop[1], 1e-3, 1e-18) << "the stop without a weight is left out";
  EXPECT_NEAR(r.force(s, 6e-3), 12.6, 1e-12);
  EXPECT_NEAR(r.press(3e-3), 6.3, 1e-12);
}

// Back from 6 to 5.2 mm: stretches 0.5 - 0.8 = -0.3 and 1 - 0.8 = 0.2 mm: 10.4 + 5.2 / 6 (-0.18 + 0.06)
// = 10.296 N. To 3 mm: both slide back: 6 - 0.3 = 5.7 N. Again to 3.4 mm: -0.1 and -0.6: 6.8 + 3.4 / 6 (-0.06
// - 0.18) N.
TEST(Stops, TurnsAsByHand) {
  const Response r = stops();
  ResponseState s;
  r.force(s, 6e-3);
  EXPECT_NEAR(r.force(s, 5.2e-3), 10.296, 1e-12);
  EXPECT_NEAR(r.force(s, 3e-3), 5.7, 1e-12);
  EXPECT_NEAR(r.force(s, 3.4e-3), 6.8 - 3.4 / 6.0 * 0.24, 1e-12);
  EXPECT_NEAR(r.release(3e-3), 5.7, 1e-12);
  EXPECT_NEAR(r.largest_gap(), r.press(4e-3) - r.release(4e-3), 0.2);
}

TEST(Stops, RecoverAtZero) {
  const Response r = stops();
  ResponseState s;
  for (const double d : {6e-3, 1e-3}) r.force(s, d);
  EXPECT_LT(s.stop[0], 0.0);
  EXPECT_EQ(r.force(s, 0.0), 0.0);
  for (const double x : s.stop) EXPECT_EQ(x, 0.0);
  EXPECT_NEAR(r.force(s, 3e-3), 6.3, 1e-12);
}

TEST(Stops, InverseAsByHand) {
  const Response r = stops();
  ResponseState s;
  EXPECT_NEAR(r.deflection(s, 6.3), 3e-3, 1e-14);
  EXPECT_NEAR(r.deflection(s, 13.0), 6e-3, 1e-18) << "at the limit";
  EXPECT_NEAR(r.deflection(s, 10.296), 5.2e-3, 1e-14);
  EXPECT_NEAR(s.stop[0], -0.3e-3, 1e-14);
  EXPECT_EQ(r.deflection(s, 0.0), 0.0);
  EXPECT_EQ(r.deflection(s, std::numeric_limits<double>::quiet_NaN()), 0.0);
  EXPECT_EQ(r.deflection(s, 12.0, 4e-3), 4e-3) << "not beyond `most`";
}

// Slope at 0, released: 2 N/mm - (0.6 * 0.5 + 0.3 * 1) / 6 = 1.9 N/mm.
TEST(Stops, LeastSlopeAsByHand) {
  EXPECT_EQ(refused(spec(), 1899.0), "");
  EXPECT_THAT(refused(spec(), 1901.0), HasSubstr("softer than the loop renders stably (1.901"));
  ResponseSpec weak = spec();
  weak.stops->curve = {0.59};
  EXPECT_THAT(refused(weak, 0.0), HasSubstr("stops' curve falls with deflection from 0.000"));
}

TEST(Stops, RefusesWhatIsNoResponse) {
  const auto with = [](auto change) {
    ResponseSpec s = spec();
    change(*s.stops);
    return refused(s);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(with([](StopsSpec& s) { s.weights[0] = -1.0; }), HasSubstr("yield energy"));
  EXPECT_THAT(with([](StopsSpec& s) { s.weights[0] = kNan; }), HasSubstr("weight"));
  EXPECT_THAT(with([](StopsSpec& s) { s.radii[1] = 0.0; }), HasSubstr("radius"));
  EXPECT_THAT(with([](StopsSpec& s) { s.radii.pop_back(); }), HasSubstr("a radius and a weight"));
  EXPECT_THAT(with([](StopsSpec& s) { s.curve = {}; }), HasSubstr("coefficients"));
  EXPECT_THAT(with([](StopsSpec& s) { s.curve.assign(9, 1.0); }), HasSubstr("1 to 8"));
  EXPECT_THAT(with([](StopsSpec& s) { s.curve[0] = kNan; }), HasSubstr("finite"));
  EXPECT_THAT(with([](StopsSpec& s) {
                s.radii.assign(17, 1e-3);
                s.weights.assign(17, 1.0);
              }),
              HasSubstr("at most 16"));
  ResponseSpec none = spec();
  none.stops.reset();
  EXPECT_THAT(refused(none), HasSubstr("no [stops]"));
}

}  // namespace
}  // namespace enc
