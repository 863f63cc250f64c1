// The Prandtl-Ishlinskii model by hand: stops, force, inverse, what is refused.
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/shape/response/response.h"

namespace enc {
namespace {

using testing::HasSubstr;

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
  try {
    const Response response(s, floor, Reversal::prandtl_ishlinskii);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

// At 0.3 mm both stops are stretched by 0.3 mm: 0.6 N + 0.05 * 0.9 * 0.3 N. At 3 mm both slide: 6 N + 0.5
// (0.6 * 0.5 + 0.3 * 1) N = 6.3 N. At 6 mm 12.6 N.
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
  EXPECT_EQ(refused(spec(), 1899.0), "accepted");
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
