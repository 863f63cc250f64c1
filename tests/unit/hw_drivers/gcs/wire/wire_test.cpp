// The text of GCS: answers, errors, commands, numbers and coordinates.
#include <array>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hw_drivers/gcs/wire/coordinates.h"
#include "hw_drivers/gcs/wire/error_text.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {
namespace {

const std::string kStream = "X=1.5 \nY=0 \nZ=-2e-3\n0\n\xB1\n(c)2019 PI, C-887.53, 1, 2\n\n20.5\n";
const std::vector<std::string> kAnswers{"X=1.5 \nY=0 \nZ=-2e-3\n",      "0\n", "\xB1\n",
                                        "(c)2019 PI, C-887.53, 1, 2\n", "\n",  "20.5\n"};

std::vector<std::string> read_in(const std::vector<std::string>& pieces) {
  std::vector<std::string> answers;
  AnswerReader reader;
  for (std::string_view piece : pieces)
    while (!piece.empty()) {
      piece.remove_prefix(reader.take(piece));
      if (!reader.complete()) continue;
      answers.emplace_back(reader.answer());
      reader.next();
    }
  return answers;
}

TEST(GcsAnswer, EndsWithALineThatNoBlankEnds) { EXPECT_EQ(read_in({kStream}), kAnswers); }

TEST(GcsAnswer, AnySegmentationGivesTheSame) {
  std::mt19937_64 random(5);
  for (int run = 0; run < 2000; ++run) {
    std::vector<std::string> pieces;
    for (std::size_t at = 0; at < kStream.size();) {
      const std::size_t size = 1 + random() % 6;
      pieces.push_back(kStream.substr(at, size));
      at += size;
    }
    ASSERT_EQ(read_in(pieces), kAnswers) << run;
  }
}

TEST(GcsAnswer, TooLongIsRefusedForGood) {
  AnswerReader reader;
  EXPECT_EQ(reader.take(std::string(kMostText, ' ')), kMostText);
  EXPECT_FALSE(reader.overflown());
  static_cast<void>(reader.take("1\n"));
  EXPECT_TRUE(reader.overflown());
  EXPECT_FALSE(reader.complete());
  reader.next();
  EXPECT_EQ(reader.take("0\n"), 2U);
  EXPECT_FALSE(reader.complete());
}

TEST(GcsAnswer, AxesInAnyOrderEachOnce) {
  std::array<double, 3> values{};
  EXPECT_TRUE(read_axes("Z=3 \nX=1 \nY=-2.5e-1\n", "XYZ", values));
  EXPECT_EQ(values, (std::array{1.0, -0.25, 3.0}));
  for (const char* text : {"", "\n", "X=1 \nY=2\n", "X=1 \nX=1 \nY=2 \nZ=3\n", "X=1 \nY=2 \nZ=\n",
                           "X=1 \nY=2 \nU=3\n", "X=1 \nY=2 \nZ=nan\n", "X 1 \nY=2 \nZ=3\n", "0\n"})
    EXPECT_FALSE(read_axes(text, "XYZ", values)) << text;
  int error = 0;
  EXPECT_TRUE(read_error("-1004\n", error));
  EXPECT_EQ(error, -1004);
  EXPECT_FALSE(read_error("X=1\n", error));
  double single = 0;
  EXPECT_TRUE(read_single("20.5\n", single));
  EXPECT_EQ(single, 20.5);
  EXPECT_FALSE(read_single("X=20.5\n", single));
}

TEST(GcsCommand, LinesAreToTheByte) {
  Text text;
  EXPECT_TRUE(add_move(text, from_wire_units({1.5, 0, -0.25, 0, 0, -2})));
  EXPECT_EQ(text.view(), "MOV X 1.5 Y 0 Z -0.25 U 0 V 0 W -2\n");
  EXPECT_FALSE(add_move(text, {0, 0, kUnset, 0, 0, 0}));
  text.clear();
  add_velocity(text, 0.02);
  add_servo(text, true);
  add_line(text, "POS?");
  EXPECT_EQ(text.view(), "VLS 20\nSVO X 1 Y 1 Z 1 U 1 V 1 W 1\nPOS?\n");
}

TEST(GcsError, EachNumberHasASentenceAndAWayOut) {
  EXPECT_EQ(error_words(5),
            "error 5: not referenced, or a servo is off; reference it (FRF) and switch the servos on (SVO)");
  EXPECT_EQ(error_words(0), "error 0: none");
  EXPECT_EQ(error_words(4711), "error 4711: look it up in the controller's manual (GCS 2)");
  int before = -1;
  for (const ErrorMeaning& one : error_meanings()) {
    EXPECT_GT(one.number, before);
    before = one.number;
    EXPECT_FALSE(one.what.empty());
    EXPECT_EQ(one.to_do.empty(), one.number == 0);
  }
  EXPECT_EQ(error_meanings().size(), 52U);
}

std::string said(double number) { return std::string(Text().add(number).view()); }

// The text of PIPython 2.11.0.6 for these numbers.
TEST(GcsText, NumbersHaveTwelveDigits) {
  EXPECT_EQ(said(1.23456789012345), "1.23456789012");
  EXPECT_EQ(said(2.0), "2");
  EXPECT_EQ(said(-0.5), "-0.5");
  EXPECT_EQ(said(20.0), "20");
  EXPECT_EQ(said(1e-7), "1e-07");
  EXPECT_EQ(said(-0.0), "0");
}

TEST(GcsText, NumbersAreReadWholeOrNotAtAll) {
  double number = 7.0;
  for (const char* text : {"", "-", "1,5", "1.5x", " 1", "nan", "inf", "1e999", "0x10", "+-1"})
    EXPECT_FALSE(read_number(text, number)) << text;
  EXPECT_EQ(number, 7.0);
  EXPECT_TRUE(read_number("+1.5", number));
  EXPECT_EQ(number, 1.5);
  EXPECT_TRUE(read_number("-2e-3", number));
  EXPECT_EQ(number, -0.002);
  int whole = 7;
  EXPECT_FALSE(read_number("1.5", whole));
  EXPECT_FALSE(read_number("99999999999", whole));
  EXPECT_TRUE(read_number("-1004", whole));
  EXPECT_EQ(whole, -1004);
}

TEST(GcsText, KeepsItsBound) {
  Text text;
  const std::string most(kMostText, 'a');
  EXPECT_FALSE(text.add(most).cut());
  EXPECT_TRUE(text.add('b').cut());
  EXPECT_EQ(text.view(), most);
  text.clear();
  EXPECT_FALSE(text.add('b').cut());
}

TEST(GcsText, WordsAreParted) {
  std::string_view text = "  MOV X\t1.5 \r";
  EXPECT_EQ(next_word(text), "MOV");
  EXPECT_EQ(next_word(text), "X");
  EXPECT_EQ(next_word(text), "1.5");
  EXPECT_EQ(next_word(text), "");
  EXPECT_EQ(trimmed(" X=1 \n"), "X=1");
  EXPECT_EQ(trimmed(" \n"), "");
}

// The two borders of the controller's coordinates, worked by hand.

constexpr double kQuarter = std::numbers::pi / 2.0;
const Stand kPlain{{0, 0, 0.1}, {0, 0, 0}, {0, 0, 0.3}};

void expect_near(const Vec3& is, const Vec3& expected) {
  EXPECT_LT((is - expected).norm(), 1e-12) << is.transpose() << " instead of " << expected.transpose();
}

TEST(GcsCoordinates, TheWireHasMillimetresAndDegrees) {
  const Coordinates wire = to_wire_units({0.001, -0.002, 0.0035, kQuarter, -kQuarter / 2, 0});
  const Coordinates expected{1, -2, 3.5, 90, -45, 0};
  for (std::size_t i = 0; i < kAxes; ++i) {
    EXPECT_NEAR(wire[i], expected[i], 1e-12);
    EXPECT_NEAR(from_wire_units(expected)[i], from_wire_units(wire)[i], 1e-15);
  }
  EXPECT_EQ(from_wire_units(expected)[0], 0.001);
  EXPECT_EQ(metres(20.0), 0.02);
  EXPECT_EQ(millimetres(0.02), 20.0);
}

TEST(GcsCoordinates, ZeroIsTheTipAtItsZero) {
  expect_near(pose_of({}, kPlain).p(), {0, 0, 0.3});
  EXPECT_EQ(pose_of({}, kPlain).q().w(), 1.0);
  expect_near(pose_of({0.001, 0.002, 0.003, 0, 0, 0}, kPlain).p(), {0.001, 0.002, 0.303});
}

// U = 90 turns y to z and z to -y: the tip, 0.2 above the pivot, goes to y = -0.2 beside it.
// V = 90 turns z to x. W = 90 turns x to y and leaves the tip, which is on the axis.
TEST(GcsCoordinates, EachAxisTurnsByTheRightHandAboutThePivot) {
  expect_near(pose_of({0, 0, 0, kQuarter, 0, 0}, kPlain).p(), {0, -0.2, 0.1});
  expect_near(pose_of({0, 0, 0, 0, kQuarter, 0}, kPlain).p(), {0.2, 0, 0.1});
  expect_near(pose_of({0, 0, 0, 0, 0, kQuarter}, kPlain).p(), {0, 0, 0.3});
  expect_near(pose_of({0, 0, 0, 0, 0, kQuarter}, kPlain).q() * Vec3(1, 0, 0), {0, 1, 0});
}

// First W, then V, then U, each about fixed axes, equals U, then V, then W about axes that turn.
// A vector along x: W = 90 makes it y; V = 90 about y leaves that; U = 90 makes it z.
// In the reverse order (first U, then V, then W) x stays, becomes -z, stays.
TEST(GcsCoordinates, TheOrderIsUThenVThenWOfThePlatform) {
  const Quat turn = pose_of({0, 0, 0, kQuarter, kQuarter * (1 - 1e-9), kQuarter}, kPlain).q();
  EXPECT_LT((turn * Vec3(1, 0, 0) - Vec3(0, 0, 1)).norm(), 1e-8);
  // U = 90 and W = 90: U alone turns z of the platform to -y, and W about it changes nothing.
  expect_near(pose_of({0, 0, 0, kQuarter, 0, kQuarter}, kPlain).q() * Vec3(0, 0, 1), {0, -1, 0});
  expect_near(pose_of({0, 0, 0, kQuarter, 0, kQuarter}, kPlain).q() * Vec3(1, 0, 0), {0, 0, 1});
}

// The pivot at the tip: the tip stays in place under any rotation.
TEST(GcsCoordinates, ThePivotStays) {
  const Stand in_tip{{0, 0, 0.1}, {0, 0, 0.2}, {0, 0, 0.3}};
  expect_near(pose_of({0, 0, 0, 0.1, -0.2, 0.3}, in_tip).p(), {0, 0, 0.3});
  const Stand beside{{0, 0, 0.1}, {0.05, 0, 0.2}, {0, 0, 0.3}};
  expect_near(pose_of({0, 0, 0, 0, 0, kQuarter}, beside).p(), {0.05, -0.05, 0.3});
}

TEST(GcsCoordinates, ThereAndBackIsTheSame) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> way(-0.05, 0.05), turn(-1.5, 1.5);
  for (int i = 0; i < 10'000; ++i) {
    const Stand stand{{way(random), 0, 0.1}, {way(random), way(random), way(random)}, {0, 0, 0.3}};
    const Coordinates at{way(random), way(random), way(random), turn(random), turn(random), turn(random)};
    Coordinates again{};
    ASSERT_TRUE(coordinates_of(pose_of(at, stand), stand, again));
    for (std::size_t axis = 0; axis < kAxes; ++axis) ASSERT_NEAR(again[axis], at[axis], 1e-12) << i;
  }
}

TEST(GcsCoordinates, WhereUAndWAreOneItIsRefused) {
  Coordinates at{1, 2, 3, 4, 5, 6};
  const Coordinates before = at;
  for (const double side : {-1.0, 1.0})
    EXPECT_FALSE(coordinates_of(pose_of({0, 0, 0, 0.3, side * kQuarter, 0}, kPlain), kPlain, at));
  EXPECT_FALSE(coordinates_of(Pose<'R', 'H'>(), kPlain, at));
  EXPECT_EQ(at, before);
  EXPECT_TRUE(coordinates_of(pose_of({0, 0, 0, 0.3, kQuarter - 1e-3, 0}, kPlain), kPlain, at));
  EXPECT_NEAR(at[4], kQuarter - 1e-3, 1e-9);
}

// The catalogue gives X, Y 50 mm, Z 25 mm, U, V 15, W 30 degrees to both sides. The rig's geometry was
// derived from that, and gets farther to one side of X.
TEST(GcsTravel, IsTheCataloguesOfTheRigsMachine) {
  const Reach reach{0.05, 0.41, Hexapod{HexapodGeometry{}}};
  const Stand stand{{0, 0, 0.1845}, {0, 0, 0}, reach.machine.zero().p()};
  const Travel travel = travel_of(reach, stand);
  const Coordinates both = to_wire_units(travel.both_sides());
  const Coordinates catalogue{50, 50, 25, 15, 15, 30};
  for (std::size_t i = 0; i < kAxes; ++i) {
    EXPECT_GE(both[i], catalogue[i] * (1 - 1e-9)) << kAxisNames[i];
    EXPECT_LE(both[i], 1.03 * catalogue[i]) << kAxisNames[i];
    Coordinates at{};
    at[i] = travel.high[i];
    EXPECT_TRUE(reach.contains(pose_of(at, stand)));
    at[i] += 1e-6;
    EXPECT_FALSE(reach.contains(pose_of(at, stand)));
  }
}

}  // namespace
}  // namespace enc::gcs
