// From a loop to a response with stops: least squares by hand, exact data, the file as text.
#include "models/identify/response/loop_fit.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/response_file.h"
#include "tests/support/plant_loop.h"

namespace enc::models {
namespace {

using testing::HasSubstr;

constexpr double kLimit = 6e-3;
constexpr double kFloor = 124.95;

// minimise (x - 1)^2 + (y + 2)^2 with x, y >= 0: (1, 0); with x + y >= 3 as well: y stays 0, so (3, 0).
TEST(LeastSquares, NonNegativeAsByHand) {
  const Quadratic q{2.0 * Eigen::MatrixXd::Identity(2, 2), Eigen::Vector2d(2.0, -4.0)};
  Constraints c{Eigen::MatrixXd::Identity(2, 2), Eigen::VectorXd::Zero(2)};
  Eigen::VectorXd x = constrained_minimum(q, c, 1e-12);
  EXPECT_NEAR(x[0], 1.0, 1e-12);
  EXPECT_NEAR(x[1], 0.0, 1e-12);
  Constraints more{Eigen::MatrixXd(3, 2), Eigen::Vector3d(0.0, 0.0, 3.0)};
  more.normals << 1, 0, 0, 1, 1, 1;
  x = constrained_minimum(q, more, 1e-12);
  EXPECT_NEAR(x[0], 3.0, 1e-12);
  EXPECT_NEAR(x[1], 0.0, 1e-12);
  more.normals << 1, 0, -1, 0, 0, 1;
  more.bounds << 1, 1, 0;
  EXPECT_THROW(static_cast<void>(constrained_minimum(q, more, 1e-12)), Error) << "x >= 1 and x <= -1";
}

// Readings that a response with stops made are given back by the fit: the same force everywhere, weights
// where they were. Two turns, so that one loop tells radii apart.
TEST(StopsFit, FindsTheResponseThatMadeTheReadings) {
  const StopsFit grid =
      fit_stops(std::vector<std::vector<LoopPoint>>{test::plant_loop({}, 4e-3, kLimit)}, kLimit, kFloor, 1e5);
  ResponseSpec made;
  made.limit = kLimit;
  made.stops = grid.spec;  // for the radii
  made.stops->curve = {6.0, 9.0, -3.0};
  made.stops->weights.assign(grid.spec.radii.size(), 0.0);
  made.stops->weights[2] = 500.0;
  made.stops->weights[7] = 300.0;
  const Response truth(made, kFloor, Reversal::prandtl_ishlinskii);
  ResponseState state;
  std::vector<LoopPoint> press;
  for (int i = 1; i <= 3000; ++i) {
    const double d = kLimit * (i <= 1500 ? i : 3000 - i) / 1500.0;
    press.push_back({d, truth.force(state, d), i <= 1500});
  }
  const StopsFit fit = fit_stops(std::vector<std::vector<LoopPoint>>{press}, kLimit, kFloor, 1e5);
  EXPECT_LT(fit.rmse, 1e-3);
  EXPECT_NEAR(fit.spec.weights[2], 500.0, 5.0);
  EXPECT_NEAR(fit.spec.weights[7], 300.0, 5.0);
  made.stops = fit.spec;
  const Response found(made, kFloor, Reversal::prandtl_ishlinskii);
  for (double d = 0.5e-3; d < kLimit; d += 0.5e-3) {
    EXPECT_NEAR(found.press(d), truth.press(d), 2e-3) << d;
    EXPECT_NEAR(found.release(d), truth.release(d), 2e-3) << d;
  }
}

TEST(StopsFit, KeepsTheCeiling) {
  const std::vector<std::vector<LoopPoint>> loop{test::plant_loop({}, 4e-3, kLimit)};
  constexpr double kCeiling = 3500.0;  // N/m
  ResponseSpec spec;
  spec.limit = kLimit;
  spec.stops = fit_stops(loop, kLimit, kFloor, kCeiling).spec;
  const Response r(spec, kFloor, Reversal::prandtl_ishlinskii);
  for (double d = 0.1e-3; d < 5.9e-3; d += 0.1e-3) {
    ResponseState s;
    r.force(s, 6e-3);
    const double above = r.force(s, d);
    ResponseState back = s;
    EXPECT_LE((r.force(back, d + 1e-6) - above) / 1e-6, kCeiling * 1.001) << d;
  }
}

// The same text gives the same bytes; the ball itself is within the intervals.
TEST(LoopFit, IsDeterministicAndKnowsTheCurve) {
  const std::string csv = test::plant_loop_csv({}, 4e-3, kLimit);
  const LoopFit a = fit_loop(parse_loop(csv, "a.csv", kLimit), {kLimit, kFloor, kUnset});
  const LoopFit b = fit_loop(parse_loop(csv, "a.csv", kLimit), {kLimit, kFloor, kUnset});
  EXPECT_EQ(response_text(a.response, a.source), response_text(b.response, b.source));
  EXPECT_EQ(a.presses, 5U);
  EXPECT_THAT(a.source, HasSubstr("SYNTHETIC"));
  EXPECT_LT(a.repeatability, 0.05);  // N: five times the same plant, noise of 0.0125 N and steps of 0.025 N
  EXPECT_GT(a.repeatability, 0.0);
  ASSERT_EQ(a.press.curve.size(), 6U);
  // The ball's force without noise, which no polynomial follows exactly, is inside of the intervals.
  for (const LoopPoint& p : test::plant_loop({}, 4e-3, kLimit)) {
    const double mm = p.deflection * 1e3;
    const auto i = static_cast<std::size_t>(std::lround(mm));
    if (i == 0 || std::abs(mm - static_cast<double>(i)) > 1e-6) continue;
    const Known& k = (p.pressing ? a.press : a.release).curve[i - 1];
    EXPECT_NEAR(k.value, p.force, k.half) << mm << (p.pressing ? " pressing" : " releasing");
    EXPECT_GT(k.half, 0.0);
    EXPECT_LT(k.half, 0.3) << "the curve is well known,";
  }
  EXPECT_GT(a.press.coefficients[1].half, 0.01 * a.press.coefficients[1].value) << "its coefficients are not";
  EXPECT_GT(std::abs(a.press.correlation), 0.99);
  EXPECT_GT(a.press.condition, 1e3);
  EXPECT_GE(a.curves.rmse_release, a.curves.rmse_release_free);
  EXPECT_GE(a.stops.rmse, a.stops.rmse_free * (1.0 - 1e-6));
}

// Positions in steps of 30 um and a pause at the top: the branches are found all the same.
TEST(LoopCsv, CoarsePositionsAndAPauseDoNotConfuseTheBranches) {
  std::string csv = "repeat,force_N,other,deflection_mm,time_s\r\n";
  int row = 0;
  const auto add = [&](double d, double force) {
    csv += fmt::format("1,{:.3f},x,{:.2f},{:.3f}\r\n", force, 0.03 * std::round(d / 0.03), ++row * 1e-3);
  };
  for (int i = 0; i <= 1500; ++i) add(6.0 * i / 1500, 2.0 * 6.0 * i / 1500);
  for (int i = 0; i < 700; ++i) add(6.0, 11.0);
  for (int i = 1500; i >= 0; --i) add(6.0 * i / 1500, 6.0 * i / 1500);
  const LoopData loop = parse_loop(csv, "coarse.csv", kLimit);
  ASSERT_EQ(loop.moving.size(), 1U);
  int wrong = 0;
  for (const LoopPoint& p : loop.moving[0]) {
    const bool on_press = std::abs(p.force - 2e3 * p.deflection) < std::abs(p.force - 1e3 * p.deflection);
    if (p.deflection > 0.5e-3 && p.deflection < 5.9e-3 && on_press != p.pressing) ++wrong;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(loop.moving[0].size(), 2800U);
  EXPECT_LT(loop.moving[0].size(), 3050U) << "most of the pause is left out";
}

std::string refused_loop(const std::string& csv) {
  try {
    static_cast<void>(parse_loop(csv, "loop.csv", kLimit));
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

TEST(LoopCsv, RefusesWithThePlaceInOneLine) {
  const std::string head = "time_s,deflection_mm,force_N,repeat\n";
  const std::string row = "0.001,1.0,2.0,1\n";
  struct Case {
    std::string csv;
    const char* begins;
    const char* says;
  };
  const std::string press_only = [&] {
    std::string text = head;
    for (int i = 1; i <= 600; ++i)
      text += fmt::format("{:.3f},{:.3f},{:.3f},1\n", i * 1e-3, i * 0.01, i * 0.02);
    return text;
  }();
  const std::vector<Case> cases{
      {"", "loop.csv:1:1:", "time_s"},
      {"time_s,deflection_mm,repeat\n" + row, "loop.csv:1:1:", "'force_N'"},
      {"time_s,deflection_um,force_N,repeat\n" + row,
       "loop.csv:1:1:", "multiply 'deflection_um' by 0.001 and call it 'deflection_mm'"},
      {"time_s,deflection_m,force_N,repeat\n" + row,
       "loop.csv:1:1:", "multiply 'deflection_m' by 1000 and call it 'deflection_mm'"},
      {"time_s,deflection_inch,force_N,repeat\n" + row,
       "loop.csv:1:1:", "multiply 'deflection_inch' by 25.4"},
      {"time_ms,deflection_mm,force_N,repeat\n" + row, "loop.csv:1:1:", "multiply 'time_ms' by 0.001"},
      {"time_s,deflection_mm,Force_N,repeat\n" + row, "loop.csv:1:1:", "rename 'Force_N'"},
      {"time_s,deflection_mm,force_N,force_N,repeat\n", "loop.csv:1:1:", "two columns 'force_N'"},
      {head + row + "0.002,abc,2.0,1\n", "loop.csv:3:7:", "'deflection_mm' is 'abc'"},
      {head + row + "0.002,1.0,nan,1\n", "loop.csv:3:11:", "finite"},
      {head + row + "0.002,1.0,inf,1\n", "loop.csv:3:11:", "finite"},
      {head + row + "0.002,1.0,,1\n", "loop.csv:3:11:", "'force_N' is ''"},
      {head + row + "0.002,1.0,1.5 N,1\n", "loop.csv:3:11:", "1.5 N"},
      {head + row + "0.001,1.1,2.0,1\n", "loop.csv:3:1:", "increasing"},
      {head + row + "0.002,1.0,2.0\n", "loop.csv:3:11:", "3 columns"},
      {head + row + "0.002,1.0,2.0,1,9\n", "loop.csv:3:17:", "5 columns"},
      {head + row + "0.002,1.0,2.0,1.5\n", "loop.csv:3:15:", "whole number"},
      {head + row + "0.002,1.0,2.0,-1\n", "loop.csv:3:15:", "whole number"},
      {head + "0.001,1.0,2.0,0\n0.002,1.0,2.0,\n", "loop.csv:3:1:", "no reading belongs to a press"},
      {head + "0.001,-1.0,2.0,1\n", "loop.csv:2:1:", "no reading belongs to a press"},
      {head + row, "loop.csv:2:1:", "deepest deflection is 1.000 mm"},
      {press_only, "loop.csv:601:1:", "0 readings while releasing"},
      {head + "1,6,2,1\n2,1,2,1\n", "loop.csv:3:1:", "at least 20"},
  };
  for (const Case& c : cases) {
    const std::string what = refused_loop(c.csv);
    EXPECT_EQ(what.rfind(c.begins, 0), 0U) << what;
    EXPECT_THAT(what, HasSubstr(c.says));
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace enc::models
