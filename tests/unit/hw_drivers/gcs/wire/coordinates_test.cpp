// The two borders of the controller's coordinates, worked by hand.
#include "hw_drivers/gcs/wire/coordinates.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "hw_drivers/gcs/wire/travel.h"

namespace enc::gcs {
namespace {

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

// First W, then V, then U, each about axes that stand: the same as U, then V, then W about axes that turn.
// A vector along x: W = 90 makes it y; V = 90 about y leaves that; U = 90 makes it z.
// In the other order (first U, then V, then W) x stays, becomes -z, stays.
TEST(GcsCoordinates, TheOrderIsUThenVThenWOfThePlatform) {
  const Quat turn = pose_of({0, 0, 0, kQuarter, kQuarter * (1 - 1e-9), kQuarter}, kPlain).q();
  EXPECT_LT((turn * Vec3(1, 0, 0) - Vec3(0, 0, 1)).norm(), 1e-8);
  // U = 90 and W = 90: z of the platform is by U alone -y, and W about it changes nothing.
  expect_near(pose_of({0, 0, 0, kQuarter, 0, kQuarter}, kPlain).q() * Vec3(0, 0, 1), {0, -1, 0});
  expect_near(pose_of({0, 0, 0, kQuarter, 0, kQuarter}, kPlain).q() * Vec3(1, 0, 0), {0, 0, 1});
}

// The pivot in the tip: it stays where it is, however it turns.
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

// The catalogue gives X, Y 50 mm, Z 25 mm, U, V 15, W 30 degrees to both sides; the rig's geometry was
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
