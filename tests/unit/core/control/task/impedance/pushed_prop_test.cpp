// The stiffness of a prop that is pushed in while pictures show the finger elsewhere: the core alone, with a
// finger and an arm at places that a test sets.
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "core/control/task/impedance/impedance_spec.h"
#include "tests/support/by_hand.h"

namespace enc {
namespace {

// A prop that a finger has pushed to `depth`, m.
struct PressedBench : test::FingerBench {
  PressedBench(const std::string& scene, double depth) : FingerBench(scene) {
    at(0.0005, 10);
    press_tip(depth);
    at(depth, 500);
  }
  [[nodiscard]] const Aim& aim() const { return recall<ImpedanceState>(loop.state).aim; }
};

constexpr int kTicks = 1000;  // in a second
constexpr int kLetsGo = static_cast<int>(AimSpec::kLetsGo * kTicks);

// Neither a picture above a lightly pushed prop nor one that ends the contact changes the force.
TEST(PushedProp, APictureAboveItChangesNoForce) {
  for (const auto& [depth, seen] :
       {std::pair{3e-4, -0.0032}, {0.005, -0.01}}) {  // the second ends the contact
    PressedBench bench("wall", depth);
    const double pushed = bench.pushed();
    EXPECT_EQ(bench.at(seen, 100).mode, seen < -0.005 ? Mode::follow : Mode::contact);
    EXPECT_NEAR(bench.pushed(), pushed, 1e-9) << seen;
    bench.press_tip(-1e-4);  // back at the surface
    bench.at(seen, 100);
    EXPECT_NEAR(bench.loop.out.arm.gain, 1.0, 1e-12);
    bench.press_tip(1e-3);  // pushed without a contact
    EXPECT_EQ(bench.at(-0.01, 100).mode, Mode::follow);
    EXPECT_NEAR(bench.loop.out.arm.gain, 1.0, 1e-12);
  }
}

// Pictures that show no finger for long are believed.
TEST(PushedProp, LetsGoAfterAWhileWithoutAFinger) {
  PressedBench bench("wall", 0.002);
  bench.at(-0.03, kLetsGo - 1);
  EXPECT_NEAR(bench.loop.out.arm.gain, 2.0, 1e-12);
  bench.at(-0.03, 100);
  EXPECT_NEAR(bench.loop.out.arm.gain, 1.0, 1e-12);
}

// A button that was pressed to its bottom comes back on the curve on which it went, wherever friction stops
// it.
TEST(PushedProp, AButtonComesBackFromItsBottom) {
  PressedBench bench("button", 0.005);
  ASSERT_TRUE(bench.aim().triggered);
  const double sunk = bench.aim().sunk, pushed = bench.pushed();
  EXPECT_GT(sunk, 0.002);
  EXPECT_EQ(bench.at(-0.03, 50).mode, Mode::follow);
  EXPECT_TRUE(bench.aim().triggered);  // a picture ends no click
  EXPECT_NEAR(bench.pushed(), pushed, 1e-9);
  bench.press_tip(0.0028);
  bench.at(-0.03, 100);
  EXPECT_LT(bench.aim().sunk, 0.5 * sunk);
  EXPECT_GT(bench.pushed(), 0.2);  // friction of 0.08 N does not hold it there
  bench.at(-0.03, kLetsGo);
  EXPECT_EQ(bench.aim().sunk, 0.0);
  EXPECT_FALSE(bench.aim().triggered);
  bench.press_tip(1e-4);
  bench.at(1e-4, 10);
  EXPECT_FALSE(bench.aim().triggered);
}

// Beside a button the prop, which waits in its middle, says nothing of the finger.
TEST(PushedProp, ThePropOfAButtonTellsNothingOfAFingerBesideIt) {
  PressedBench bench("button", 0.005);
  bench.press_tip(0.0007);  // came up as the finger slid away
  bench.at(0.005, 50);
  for (int i = 2; i <= 40; ++i) {
    const double x = 5e-4 * i;
    bench.at(0.005, 10, x);
    EXPECT_EQ(bench.aim().sunk, 0.0) << x;
    EXPECT_FALSE(bench.aim().triggered) << x;
  }
  EXPECT_EQ(bench.loop.out.mode, Mode::follow);
}

}  // namespace
}  // namespace enc
