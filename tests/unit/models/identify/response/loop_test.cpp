// A response with stops from a loop: least squares by hand, exact data, the file as text.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/base/error.h"
#include "models/identify/response/loop_csv.h"
#include "models/identify/response/loop_fit.h"
#include "models/response_file.h"
#include "tests/support/plant_loop.h"
#include "tests/support/refusal.h"

namespace enc::models {
namespace {

using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

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

// The fit recovers a response with stops from its own readings: equal force everywhere, equal weights. Two
// turns let one loop separate the radii.
TEST(StopsFit, FindsTheResponseThatMadeTheReadings) {
  const StopsFit grid =
      fit_stops(std::vector<std::vector<LoopPoint>>{test::plant_loop({}, 4e-3, kLimit)}, kLimit, kFloor, 1e5);
  ResponseSpec made{.limit = kLimit};
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
  ResponseSpec spec{.limit = kLimit};
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

// Equal text gives equal bytes; the ball itself is within the intervals.
TEST(LoopFit, IsDeterministicAndKnowsTheCurve) {
  const std::string csv = test::plant_loop_csv({}, 4e-3, kLimit);
  const LoopFit a = fit_loop(parse_loop(csv, "a.csv", kLimit), {kLimit, kFloor, kUnset});
  const LoopFit b = fit_loop(parse_loop(csv, "a.csv", kLimit), {kLimit, kFloor, kUnset});
  EXPECT_EQ(response_text(a.response, a.source), response_text(b.response, b.source));
  EXPECT_EQ(a.presses, 5U);
  EXPECT_THAT(a.source, HasSubstr("SYNTHETIC"));
  EXPECT_LT(a.repeatability, 0.05);  // N: one plant five times, noise of 0.0125 N and steps of 0.025 N
  EXPECT_GT(a.repeatability, 0.0);
  ASSERT_EQ(a.press.curve.size(), 6U);
  // The ball's force without noise, which no polynomial follows exactly, is inside the intervals.
  for (const LoopPoint& p : test::plant_loop({}, 4e-3, kLimit)) {
    const double mm = p.deflection * 1e3;
    const auto i = static_cast<std::size_t>(std::lround(mm));
    if (i == 0 || std::abs(mm - static_cast<double>(i)) > 1e-6) continue;
    const LoopEstimate& k = (p.pressing ? a.press : a.release).curve[i - 1];
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

// Positions in steps of 30 um and a pause at the top: the reader still finds the branches.
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
  return test::refusal([&] { (void)parse_loop(csv, "loop.csv", kLimit); });
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

// The zero, the start of contact and the branches of a press: by hand, on loops without noise.

constexpr double kPressedTo = 6e-3;

// Deflection over time, s and mm, straight from one point to the next, read at 1 kHz.
struct Turn {
  double time, deflection;
};
double place(const std::vector<Turn>& turns, double t) {
  std::size_t k = 1;
  while (k + 1 < turns.size() && t > turns[k].time) ++k;
  const Turn &a = turns[k - 1], &b = turns[k];
  return a.deflection + (t - a.time) / (b.time - a.time) * (b.deflection - a.deflection);
}

using Force = std::function<double(double deflection, double time)>;  // mm, s, N
std::string csv(const std::vector<std::vector<Turn>>& presses, const Force& force, bool marks_all = true) {
  std::string text = "time_s,deflection_mm,force_N,repeat\n";
  double start = 0.0;
  int repeat = 0;
  for (const auto& turns : presses) {
    ++repeat;
    for (double t = 0.0; t <= turns.back().time; t += 1e-3) {
      const double d = place(turns, t);
      text += fmt::format("{:.3f},{:.6f},{:.6f},{}\n", start + t, d, force(d, start + t),
                          marks_all || d > 0.0 ? repeat : 0);
    }
    start += turns.back().time + 1.0;
  }
  return text;
}
const std::vector<Turn> kPress{{0, -2}, {2, 6}, {4, -2}};

// 1 N/mm, and the deviation from it.
LoopData read(const std::vector<std::vector<Turn>>& presses, const Force& force, bool marks_all = true) {
  return parse_loop(csv(presses, force, marks_all), "loop.csv", kPressedTo);
}
double line(double d) { return std::max(0.0, d); }

std::string refusal(const std::string& text) {
  return test::refusal([&] { (void)parse_loop(text, "loop.csv", kPressedTo); });
}

void expect_line(const LoopData& loop, double near = 1e-3) {
  for (const auto& press : loop.moving)
    for (const LoopPoint& p : press) ASSERT_NEAR(p.force, 1e3 * p.deflection, near) << p.time;
}

TEST(LoopContact, WhatIsRightIsLeftAsItIs) {
  const LoopData loop = read({kPress, kPress}, [](double d, double) { return line(d); });
  EXPECT_THAT(loop.notes, IsEmpty());
  EXPECT_EQ(loop.zero_error, 0.0);
  EXPECT_EQ(loop.begin_error, 0.0);
  ASSERT_EQ(loop.presses.size(), 2U);
  expect_line(loop, 1e-9);
}

TEST(LoopContact, AForceBeforeContactIsSubtracted) {
  const LoopData loop = read({kPress, kPress}, [](double d, double) { return line(d) + 0.6; });
  EXPECT_THAT(loop.notes, ElementsAre("before contact the force is 0.60 N: subtracted"));
  expect_line(loop);
}

// The zero rises by 0.05 N/s from 0.1 N on: it is a line between before and after each press.
TEST(LoopContact, AZeroThatDriftsIsSubtractedAtEachTime) {
  const LoopData loop = read(
      {kPress, kPress}, [](double d, double t) { return line(d) + 0.1 + 0.05 * t; }, false);
  ASSERT_EQ(loop.notes.size(), 1U);
  EXPECT_THAT(loop.notes[0], testing::MatchesRegex("before contact the force is 0.1[0-9] to 0.3[0-9] N: "
                                                   "subtracted"));
  expect_line(loop, 5e-3);
}

// A drift of 0.2 N/s moves the zero by 0.8 N during a press of 4 s and 6 N.
TEST(LoopContact, AZeroThatDriftsFarWithinAPressIsSubtracted) {
  for (const std::size_t presses : {1U, 2U, 3U})
    for (const double rate : {0.2, -0.2, 1.0})
      for (const bool marks_all : {true, false}) {
        const LoopData loop = read(
            std::vector(presses, kPress), [&](double d, double t) { return line(d) + rate * t; }, marks_all);
        EXPECT_THAT(loop.notes,
                    testing::Contains(
                        AllOf(HasSubstr(fmt::format("the zero of the force drifts by {:g} N/s: ", rate)),
                              HasSubstr("a straight line in time from before each press to after it"))));
        EXPECT_FALSE(loop.doubted);
        expect_line(loop, 5e-3);
      }
}

// The object holds on to the probe with 0.5 N: that is no zero, and the reader does not subtract it.
TEST(LoopContact, AnotherForceAfterAPressIsToldAndNotSubtracted) {
  const auto clings = [](double d, double t) {
    return std::fmod(t, 5.0) > 2.0 ? d > 0.0 ? d : -0.5 : line(d);
  };
  const LoopData loop = read({kPress, kPress}, clings);
  EXPECT_THAT(loop.notes, ElementsAre(AllOf(
                              HasSubstr("after press 1 the force is -0.50 N, against the zero before it"),
                              HasSubstr("only the one before is subtracted"), HasSubstr("record on until"))));
  EXPECT_TRUE(loop.doubted);
  expect_line(loop, 1e-9);
}

TEST(LoopContact, AZeroThatMovesFromPressToPressIsToldWhereNothingSaysWhen) {
  const std::vector<Turn> ends_in_contact{{0, -2}, {2, 6}, {3.4, 0.4}};
  const LoopData loop =
      read({ends_in_contact, ends_in_contact}, [](double d, double t) { return line(d) + 0.2 * t; });
  EXPECT_THAT(loop.notes, testing::Contains(HasSubstr("no reading after a press tells by how much")));
  EXPECT_TRUE(loop.doubted);
  EXPECT_FALSE(read({ends_in_contact, ends_in_contact}, [](double d, double) { return line(d); }).doubted);
}

TEST(LoopContact, WithoutAZeroAReleaseHasToEndWhereThePressBegan) {
  const std::vector<Turn> press{{0, 0.004}, {1.5, 6}, {3, 0.004}};
  const LoopData loop = read({press}, [](double d, double t) { return line(d) + 0.2 * t; });
  EXPECT_THAT(loop.notes, ElementsAre(HasSubstr("the press begins with 0.00 N at 0 mm and the release ends "
                                                "with 0.60 N")));
  EXPECT_TRUE(loop.doubted);
  EXPECT_FALSE(read({press}, [](double d, double) { return line(d); }).doubted);
}

// A force sensor with a range of 4 N, with its noise before its limit or after it.
TEST(LoopContact, ASensorAtItsLimitIsRefused) {
  const auto noise = [](double t) { return 0.02 * std::sin(1e6 * t); };
  for (const bool after : {true, false}) {
    const auto clipped = [&](double d, double t) {
      return after ? std::min(4.0, line(d)) + noise(t) : std::min(4.0, line(d) + noise(t));
    };
    const std::string said = refusal(csv({kPress, kPress}, clipped));
    EXPECT_THAT(said, testing::MatchesRegex("loop.csv:1[45][0-9][0-9]:1: from (3.9|4.0)[0-9] mm on the force "
                                            "stays at (3.9|4.0)[0-9] N while it is pressed deeper: .*limit.* "
                                            "give --limit-mm (3.9|4)"));
    EXPECT_EQ(parse_loop(csv({kPress, kPress}, clipped), "loop.csv", 3.9e-3).notes.size(), 0U);
  }
  // A slightly cut peak is no plateau.
  for (const double depth : {0.3, 0.05, 0.0})
    EXPECT_EQ(
        refusal(csv({kPress},
                    [&](double d, double t) { return std::min(6.0 - depth, line(d)) + noise(t); })) == "",
        depth < 0.1)
        << depth;
  const auto in_steps = [](double d, double) { return 0.1 * std::round(10.0 * line(d)); };
  EXPECT_EQ(refusal(csv({kPress}, in_steps)), "");
}

TEST(LoopContact, AForceInAnotherUnitIsAskedFor) {
  const auto in_unit = [](double factor) {
    return refusal(csv({kPress}, [&](double d, double) { return factor * line(d); }));
  };
  EXPECT_THAT(in_unit(1e3), AllOf(HasSubstr("the force reaches 6000 N within 6 mm; expected at most 300 N"),
                                  HasSubstr("if force_N is in mN, multiply it by 0.001"),
                                  HasSubstr("; if in gram-force, multiply it by 0.00980665")));
  EXPECT_THAT(in_unit(1e5), HasSubstr("see to the unit of force_N"));
  EXPECT_EQ(in_unit(40), "");
}

TEST(LoopContact, ContactThatBeginsElsewhereIsShifted) {
  for (const double begin : {-0.5, 0.2, 2.0}) {
    const std::vector<Turn> press{{0, begin - 2}, {2, begin + 6}, {4, begin - 2}};
    for (const bool marks_all : {true, false}) {
      const LoopData loop = read(
          {press, press}, [&](double d, double) { return line(d - begin); }, marks_all);
      EXPECT_THAT(loop.notes, ElementsAre(fmt::format("contact begins at {:.2f} mm: shifted", begin)));
      expect_line(loop, 3e-3);
      double deepest = 0.0;
      for (const LoopPoint& p : loop.presses[0]) deepest = std::max(deepest, p.deflection);
      EXPECT_NEAR(deepest, 6e-3, 3e-6);
    }
  }
}

// A force that leaves its zero slowly gives no place of contact: the reader does not shift it.
TEST(LoopContact, ASoftBeginIsNoOffset) {
  const LoopData loop = read({kPress}, [](double d, double) { return std::pow(line(d), 1.5); });
  EXPECT_THAT(loop.notes, IsEmpty());
}

TEST(LoopContact, AFileThatBeginsInContactHasToBeginAtZero) {
  const std::vector<Turn> press{{0, 0.004}, {1.5, 6}, {3, 0.004}};
  EXPECT_EQ(refusal(csv({press}, [](double d, double) { return line(d); })), "");
  EXPECT_THAT(
      refusal(csv({press}, [](double d, double) { return line(d) + 0.6; })),
      AllOf(HasSubstr("at 0 mm the force is 0.60 N, and no reading from before contact gives its zero"),
            HasSubstr("record from before contact, or")));
  const LoopData slight = read({press}, [](double d, double) { return line(d) + 0.1; });
  EXPECT_THAT(slight.notes, ElementsAre(HasSubstr("at 0 mm the force is 0.10 N")));
  EXPECT_THAT(read({press}, [](double d, double) { return line(d); }).notes, IsEmpty());
  const std::vector<Turn> gap{{0, 2.004}, {1.5, 8}, {3, 2.004}};
  EXPECT_THAT(refusal(csv({gap}, [](double d, double) { return line(d - 2.0); })),
              HasSubstr("contact begins at 2.00 mm, and no reading from before it gives the zero"));
}

TEST(LoopContact, ALengthInAnotherUnitIsAskedFor) {
  const auto in_unit = [](double factor) {
    std::string text = "time_s,deflection_mm,force_N,repeat\n";
    for (int i = 0; i < 600; ++i) {
      const double d = 0.02 * std::min(i, 600 - i);
      text += fmt::format("{:.3f},{:.7f},{:.4f},1\n", i * 1e-3, factor * d, d);
    }
    return refusal(text);
  };
  EXPECT_THAT(in_unit(1e-3), HasSubstr("if deflection_mm is in m, multiply it by 1000"));
  EXPECT_THAT(in_unit(1e3), HasSubstr("if deflection_mm is in micrometres, multiply it by 0.001"));
}

TEST(LoopContact, AClockThatBeginsAnewIsNotUnsorted) {
  std::string text = "time_s,deflection_mm,force_N,repeat\n";
  for (int repeat = 1; repeat <= 2; ++repeat)
    for (int i = 0; i < 10; ++i) text += fmt::format("{},{},{},{}\n", i, i, i, repeat);
  EXPECT_THAT(refusal(text),
              AllOf(HasSubstr("loop.csv:12:1: the time 0 s comes after 9 s: time begins anew at repeat 2"),
                    HasSubstr("add the last time"), testing::Not(HasSubstr("sort"))));
  EXPECT_THAT(refusal("time_s,deflection_mm,force_N,repeat\n0,0,0,1\n1,0,0,1\n2,0,0,1\n1.5,0,0,1\n"),
              AllOf(HasSubstr("loop.csv:5:1:"), HasSubstr("sort the rows")));
}

// A press that overshoots, waits, settles, and goes back fast: neither branch has a reading of the hold.
TEST(LoopBranches, AHoldBelongsToNeither) {
  const std::vector<Turn> press{{0, -2}, {2, 6.04}, {2.1, 6}, {12, 6}, {12.2, -2}};
  LoopData loop = read({press}, [](double d, double t) {
    return t <= 2.0 ? line(d) : t < 12.0 ? 5.5 : 0.5 * line(d);
  });
  int pressing = 0, releasing = 0;
  for (const LoopPoint& p : loop.moving.at(0)) {
    ASSERT_NEAR(p.force, (p.pressing ? 1e3 : 0.5e3) * p.deflection, 1e-6) << p.time;
    ++(p.pressing ? pressing : releasing);
  }
  EXPECT_GT(pressing, 1400);  // of 1510
  EXPECT_GT(releasing, 120);  // of 150
  EXPECT_GT(loop.presses.at(0).size(), 11000U);
  for (const LoopPoint& p : loop.presses[0]) ASSERT_TRUE(p.held || p.force != 5.5) << p.time;
}

// A hand that holds a depth trembles, here at 9 Hz: its strokes are neither a press nor a release, at the
// deepest place or on the way in.
TEST(LoopBranches, ATremorOfAHoldBelongsToNeither) {
  for (const double held_at : {6.0, 3.0})
    for (const double size : {0.1, 0.2, 0.3}) {
      const auto way = [&](double t) {
        const double reached = (held_at + 2.0) / 4.0;
        if (t < reached) return -2.0 + 4.0 * t;
        if (t < reached + 10.0) return held_at + size * std::sin(2.0 * M_PI * 9.0 * (t - reached));
        return t < 12.0 ? -2.0 + 4.0 * (t - 10.0) : 6.0 - 4.0 * (t - 12.0);
      };
      std::string text = "time_s,deflection_mm,force_N,repeat\n";
      for (int i = 0; i <= 14000; ++i) {
        const double t = 1e-3 * i, d = way(t), from = (held_at + 2.0) / 4.0;
        // The first stroke up to its turn still belongs to the press.
        const bool holds = t > from + 0.03 && t < from + 10.0;
        text += fmt::format("{:.3f},{:.6f},{:.6f},1\n", t, d,
                            holds      ? 5.0
                            : t < 12.0 ? line(d)
                                       : 0.5 * line(d));
      }
      int pressing = 0, releasing = 0;
      const LoopData loop = parse_loop(text, "loop.csv", kPressedTo);
      for (const LoopPoint& p : loop.moving.at(0)) {
        ASSERT_NEAR(p.force, (p.pressing ? 1e3 : 0.5e3) * p.deflection, 1e-6) << p.time << ' ' << size;
        ++(p.pressing ? pressing : releasing);
      }
      EXPECT_GT(pressing, 1300) << held_at << ' ' << size;
      EXPECT_GT(releasing, 1300) << held_at << ' ' << size;
    }
}

// The probe goes in, part of the way back and in again: that piece is on neither curve.
TEST(LoopBranches, AMinorLoopBelongsToNeither) {
  const std::vector<Turn> press{{0, -2}, {1.5, 4}, {2, 2}, {3, 6}, {4, 2}, {4.5, 4}, {6, -2}};
  const LoopData loop = read({press}, [](double d, double t) {
    const bool minor = (t > 1.5 && t < 2.5) || (t > 4.0 && t < 5.0);
    return minor ? 0.0 : line(d);
  });
  for (const LoopPoint& p : loop.moving.at(0))
    EXPECT_TRUE(p.force > 0.0 || std::abs(p.deflection - (p.pressing ? 4e-3 : 2e-3)) < 0.1e-3) << p.time;
  EXPECT_GT(loop.moving[0].size(), 2500U);
}

TEST(LoopBranches, PressesUnderOneNumberAreCountedSingly) {
  std::string text = csv({kPress, kPress, kPress}, [](double d, double) { return line(d); });
  for (const char* repeat : {",2\n", ",3\n"})
    for (std::size_t at = text.find(repeat); at != std::string::npos; at = text.find(repeat, at))
      text.replace(at, 3, ",1\n");
  const LoopData loop = parse_loop(text, "loop.csv", kPressedTo);
  EXPECT_EQ(loop.presses.size(), 3U);
  expect_line(loop);
}

// The accuracy of a force at a deflection from repeats alone: Student's interval of their mean.

// Presses of one line, 2 N/mm up and 1.9 N/mm back; each as a whole higher by `shifts`, N.
LoopData presses(const std::vector<double>& shifts) {
  LoopData loop;
  for (const double shift : shifts) {
    loop.moving.emplace_back();
    for (int i = 1; i < 1200; ++i) {
      const double d = 1e-5 * std::min(i, 1200 - i);
      loop.moving.back().push_back({d, (i <= 600 ? 2000.0 : 1900.0) * d + shift, i <= 600});
    }
    loop.presses.push_back(loop.moving.back());
  }
  return loop;
}

// Three presses at -0.01, 0 and 0.01 N: their standard deviation is 0.01 N, Student's t of 2 is 4.30, so the
// mean is known to 4.30 * 0.01 / sqrt(3) = 0.0248 N. (t comes from a series, some per cent off at 2.)
TEST(LoopRepeats, IntervalOfTheMeanAsByHand) {
  const LoopFit fit = fit_loop(presses({-0.01, 0.0, 0.01}), {6e-3, 100.0, 1e5});
  for (const BranchEstimate* branch : {&fit.press, &fit.release}) {
    ASSERT_EQ(branch->repeats.size(), 6U);
    for (const double half : branch->repeats) EXPECT_NEAR(half, 0.0248, 0.003);
  }
}

TEST(LoopRepeats, TwoSayNothing) {
  for (const double half : fit_loop(presses({0.0, 0.01}), {6e-3, 100.0, 1e5}).press.repeats)
    EXPECT_TRUE(std::isnan(half));
}

}  // namespace
}  // namespace enc::models
