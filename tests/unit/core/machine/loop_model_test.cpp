#include "core/machine/loop_model.h"

#include <gtest/gtest.h>

namespace enc {
namespace {

// 1st-order filter and servo of one corner w, damping ratio 1/2, no delay, a pure spring k_h as hand:
//   k (s^2 + w s + w^2)(s + w) + k_h w^3 = 0  =>  s^3 + 2 w s^2 + 2 w^2 s + w^3 (1 + k_h / k) = 0
// Routh: 2 w * 2 w^2 > w^3 (1 + k_h / k)  <=>  k > k_h / 3.
TEST(LoopModel, AgreesWithRouthByHand) {
  const LoopModel loop{.hand_stiffness = 300.0,
                       .hand_damping = 0.0,
                       .filter_hz = 10.0,
                       .servo_hz = 10.0,
                       .servo_damping = 0.5,
                       .delay = 0.0};
  EXPECT_NEAR(lowest_stable_stiffness(loop), 100.0, 1e-6);
}

// The same with a damper b: k_h w^3 becomes (b s + k_h) w^3. With B = b w / k, K = k_h / k:
//   s^3 + 2 w s^2 + (2 + B) w^2 s + (1 + K) w^3 = 0, stable for 2 (2 + B) > 1 + K  <=>  3 k > k_h - 2 b w.
// k_h = 300 N/m, b = 1 N s/m, w = 30 rad/s: k > (300 - 60) / 3 = 80 N/m.
TEST(LoopModel, HandDampingHelpsAsByHand) {
  constexpr double kHz = 30.0 / (2.0 * 3.14159265358979323846);
  const LoopModel loop{.hand_stiffness = 300.0,
                       .hand_damping = 1.0,
                       .filter_hz = kHz,
                       .servo_hz = kHz,
                       .servo_damping = 0.5,
                       .delay = 0.0};
  EXPECT_NEAR(lowest_stable_stiffness(loop), 80.0, 1e-6);
}

// Without a damper and without mass the characteristic equation holds k_h / k only.
TEST(LoopModel, ScalesWithAPureSpringHand) {
  LoopModel loop{.hand_stiffness = 130.0, .hand_damping = 0.0};
  const double once = lowest_stable_stiffness(loop);
  EXPECT_GT(once, 0.0);
  for (const double factor : {0.1, 2.0, 7.0}) {
    loop.hand_stiffness = 130.0 * factor;
    EXPECT_NEAR(lowest_stable_stiffness(loop), once * factor, 1e-9 * once * factor);
  }
}

// sources/hexapod 5, baseline: k_h 130 N/m, b_h 2.2 N s/m, f_s 15 Hz, zeta 0.8, n_d 4 cycles (+1), f_c 5 Hz
// -> 0.022 N/mm.
TEST(LoopModel, GivesTheLinearBoundaryOfTheFidelityBaseline) {
  const LoopModel loop{.hand_stiffness = 130.0,
                       .hand_damping = 2.2,
                       .filter_hz = 5.0,
                       .servo_hz = 15.0,
                       .servo_damping = 0.8,
                       .delay = 0.005};
  EXPECT_NEAR(lowest_stable_stiffness(loop), 22.0, 0.5);
}

// Without delay the grip's damper (4 N s/m) keeps the loop stable at every stiffness; with delay it cannot.
TEST(LoopModel, MoreDelayNeedsAStifferObject) {
  LoopModel loop{.delay = 0.0};
  double before = lowest_stable_stiffness(loop);
  EXPECT_EQ(before, 0.0);
  for (const double delay : {0.005, 0.010, 0.020}) {
    loop.delay = delay;
    const double floor = lowest_stable_stiffness(loop);
    EXPECT_GT(floor, before) << "delay " << delay << " s";
    before = floor;
  }
}

}  // namespace
}  // namespace enc
