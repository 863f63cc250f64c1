// The damper beside a rendered object: its law worked by hand, what it sees, and how it forgets.
#include "core/control/task/render/damping.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/machine/loop_model.h"

namespace enc {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDt = 1e-3;

double gain_of(double hz) { return 1.0 - std::exp(-2.0 * kPi * hz * kDt); }

// Filter 5 Hz, servo 15 Hz and 0.8, dead time 5 ms; commands 0.32 m/s^2 along the normal.
DampingLaw law(const AdmittanceRig& rig = {}) { return {rig, LoopModel{}, gain_of(5.0), 0.32, kDt}; }

Response spring(double stiffness) {
  ResponseSpec spec;
  spec.press = spec.release = {stiffness, 0, 0, 0};
  spec.limit = 0.02;
  return {spec, 0.0};
}

TEST(Damping, LagIsTheSumOfItsParts) {
  // 1 / (2 pi 5) + 2 * 0.8 / (2 pi 15) + 0.005 + 2 ticks
  EXPECT_NEAR(law().lag(), 0.031831 + 0.016977 + 0.005 + 0.002, 1e-6);
}

TEST(Damping, OneStepOfTheDamperByHand) {
  // k = 100 N/m, b = 10 N s/m: b/k = 0.1 s; of 1 N the spring carries dt / (dt + b/k) after one tick.
  const Response object = spring(100.0);
  EXPECT_NEAR(law().carry(object, ResponseState{}, 0.0, 1.0, 10.0, 0.02), 1e-3 / 0.101, 1e-12);
  // Half carried already, at 5 mm: half of that on top of a half.
  ResponseState half;
  object.deflection(half, 0.5);
  EXPECT_NEAR(law().carry(object, half, 0.5, 1.0, 10.0, 0.02), 0.5 + 0.5e-3 / 0.101, 1e-12);
}

TEST(Damping, NoDamperCarriesNothing) {
  const Response object = spring(100.0);
  EXPECT_EQ(law().carry(object, ResponseState{}, 0.0, 0.7, 0.0, 0.02), 0.7);
  // At the limit nothing moves, so there is nothing to damp.
  ResponseState at_limit;
  object.deflection(at_limit, 2.0);
  EXPECT_EQ(law().carry(object, at_limit, 2.0, 3.0, 10.0, 0.02), 3.0);
}

TEST(Damping, SettlesWithDampingOverStiffness) {
  const Response object = spring(100.0);
  ResponseState at;
  double carried = 0.0;
  for (int i = 0; i < 100; ++i) {  // b/k = 0.1 s
    carried = law().carry(object, at, carried, 1.0, 10.0, 0.02);
    object.deflection(at, carried);
  }
  EXPECT_NEAR(carried, 1.0 - std::exp(-1.0), 0.002);
  EXPECT_NEAR(at.deflection, carried / 100.0, 1e-9);
}

// A tip that swings by `amplitude` at 4 Hz against a spring of k, the force low-passed as the depth is.
double swing(const DampingLaw& damping, Swing& seen, double k, double amplitude, double seconds) {
  double force = 0.0;
  double b = 0.0;
  for (int i = 0; i < static_cast<int>(seconds / kDt); ++i) {
    const double depth = amplitude * std::sin(2.0 * kPi * 4.0 * i * kDt);
    force += gain_of(5.0) * (-k * depth - force);
    b = damping.observe(seen, force, depth);
  }
  return b;
}

TEST(Damping, SeesTheStiffnessThatItSwingsAgainst) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  swing(damping, seen, 500.0, 1e-3, 3.0);
  // Low-pass (5 Hz) and high-pass (1 Hz) leave of 1 mm at 4 Hz: 1 / sqrt(1 + 0.64) / sqrt(1 + 1/16).
  const double moved = 0.5e-6 / 1.64 / 1.0625;
  EXPECT_NEAR(seen.moved, moved, 0.15 * moved);
  EXPECT_NEAR(seen.exchanged, 500.0 * seen.moved, 1e-3 * 500.0 * seen.moved);
  EXPECT_NEAR(seen.stiffness, 500.0, 2.0);
}

TEST(Damping, IsTheRuleTimesTheMargin) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  const double b = swing(damping, seen, 500.0, 1e-3, 3.0);
  const double wide = 2.0 * std::sqrt(std::sqrt(2.0 * seen.moved) / 0.32);
  EXPECT_NEAR(b, 2.0 * (2.0 / kPi) * (damping.lag() + wide) * seen.stiffness, 1e-9);
  AdmittanceRig weak;
  weak.most_damping = 20.0;
  Swing again = law(weak).begin(1e6, 0.0, 0.0);
  EXPECT_EQ(swing(law(weak), again, 500.0, 1e-3, 3.0), 20.0);
}

TEST(Damping, ForgetsWhenItIsCalm) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  swing(damping, seen, 500.0, 1e-3, 3.0);
  for (int i = 0; i < 3000; ++i) damping.observe(seen, 0.0, 0.0);  // what still rings in the filters
  const double before = seen.stiffness;
  for (int i = 0; i < 1000; ++i) damping.observe(seen, 0.0, 0.0);
  EXPECT_NEAR(seen.stiffness / before, std::exp(-1.0), 1e-3);  // calm_time is 1 s
}

TEST(Damping, AUserWhoPushesIsNoSwing) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  EXPECT_EQ(swing(damping, seen, -500.0, 1e-3, 3.0), 0.0);  // force rises with depth: the object gives in
  EXPECT_LT(seen.exchanged, 0.0);
}

TEST(Damping, SmallerThanTheLeastSwingCountsLittle) {
  const DampingLaw damping = law();
  Swing seen = damping.begin(1e6, 0.0, 0.0);
  swing(damping, seen, 500.0, 1e-6, 3.0);
  EXPECT_LT(seen.stiffness, 1.0);
}

TEST(Damping, BeginsWithTheHandOnWhatIsTooSoft) {
  const DampingLaw damping = law();
  const double lowest = lowest_stable_stiffness(LoopModel{});
  EXPECT_EQ(damping.begin(0.9 * lowest, 0.0, 0.0).stiffness, LoopModel{}.hand_stiffness);
  EXPECT_EQ(damping.begin(1.1 * lowest, 0.0, 0.0).stiffness, 0.0);
}

}  // namespace
}  // namespace enc
