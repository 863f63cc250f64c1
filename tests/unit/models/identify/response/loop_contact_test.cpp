// The zero, the begin of contact and the branches of a press: by hand, on loops without noise.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/identify/response/loop_csv.h"

namespace enc::models {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kPressedTo = 6e-3;

// Deflection over time, s and mm, straight from one to the next, read at 1 kHz.
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

// 1 N/mm, and how it differs from that.
LoopData read(const std::vector<std::vector<Turn>>& presses, const Force& force, bool marks_all = true) {
  return parse_loop(csv(presses, force, marks_all), "loop.csv", kPressedTo);
}
double line(double d) { return std::max(0.0, d); }

std::string refusal(const std::string& text) {
  try {
    static_cast<void>(parse_loop(text, "loop.csv", kPressedTo));
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
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

// From 0.1 N on it rises by 0.05 N/s: the zero is a line between before and after each press.
TEST(LoopContact, AZeroThatDriftsIsSubtractedAtEachTime) {
  const LoopData loop = read(
      {kPress, kPress}, [](double d, double t) { return line(d) + 0.1 + 0.05 * t; }, false);
  ASSERT_EQ(loop.notes.size(), 1U);
  EXPECT_THAT(loop.notes[0], testing::MatchesRegex("before contact the force is 0.1[0-9] to 0.3[0-9] N: "
                                                   "subtracted"));
  expect_line(loop, 5e-3);
}

// A drift of 0.2 N/s moves the zero by 0.8 N during a press of 4 s, of 6 N.
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

// The object holds on to the probe with 0.5 N: that is no zero, and nothing moves it.
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

// A force sensor that goes up to 4 N, with its noise before its limit or after it.
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
  // An edge that is barely cut is no plateau.
  for (const double depth : {0.3, 0.05, 0.0})
    EXPECT_EQ(refusal(csv({kPress},
                          [&](double d, double t) { return std::min(6.0 - depth, line(d)) + noise(t); })) ==
                  "accepted",
              depth < 0.1)
        << depth;
  const auto in_steps = [](double d, double) { return 0.1 * std::round(10.0 * line(d)); };
  EXPECT_EQ(refusal(csv({kPress}, in_steps)), "accepted");
}

TEST(LoopContact, AForceInAnotherUnitIsAskedFor) {
  const auto in_unit = [](double factor) {
    return refusal(csv({kPress}, [&](double d, double) { return factor * line(d); }));
  };
  EXPECT_THAT(in_unit(1e3), AllOf(HasSubstr("the force reaches 6000 N within 6 mm; expected at most 300 N"),
                                  HasSubstr("if force_N is in mN, multiply it by 0.001"),
                                  HasSubstr("; if in gram-force, multiply it by 0.00980665")));
  EXPECT_THAT(in_unit(1e5), HasSubstr("see to the unit of force_N"));
  EXPECT_EQ(in_unit(40), "accepted");
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

// A force that leaves its zero slowly does not say where: nothing is shifted.
TEST(LoopContact, ASoftBeginIsNoOffset) {
  const LoopData loop = read({kPress}, [](double d, double) { return std::pow(line(d), 1.5); });
  EXPECT_THAT(loop.notes, IsEmpty());
}

TEST(LoopContact, AFileThatBeginsInContactHasToBeginAtZero) {
  const std::vector<Turn> press{{0, 0.004}, {1.5, 6}, {3, 0.004}};
  EXPECT_EQ(refusal(csv({press}, [](double d, double) { return line(d); })), "accepted");
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
        // The first stroke up to its turn still is of the press.
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

// In, part of the way back and in again: that piece is on neither curve.
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

}  // namespace
}  // namespace enc::models
