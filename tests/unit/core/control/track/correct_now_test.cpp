// What something that knows better than pictures makes of a prediction.
#include <cmath>

#include <gtest/gtest.h>

#include "core/control/track/predict.h"

namespace enc {
namespace {

Time at_ms(int ms) { return Time(Duration(1'000'000) * ms); }

TrackerRig rig_with(Prediction prediction) {
  TrackerRig rig;
  rig.prediction = prediction;
  return rig;
}

// A tip that goes along x with 0.1 m/s, seen each 10 ms for 100 ms.
TipMotion seen(const TrackerRig& rig) {
  TipMotion motion;
  for (int ms = 0; ms <= 100; ms += 10)
    observe(rig, 0, at_ms(ms), Point<'W'>(1e-4 * ms, 0, 0), {rig.measurement_noise, rig.measurement_noise},
            motion);
  return motion;
}

// It is stopped: place and velocity say so, their doubt stays, and to the sides nothing changes.
TEST(CorrectNow, WhatIsKnownNowIsWhatIsPredictedNow) {
  for (const Prediction how : {Prediction::constant_velocity, Prediction::constant_acceleration}) {
    const TrackerRig rig = rig_with(how);
    TipMotion motion = seen(rig);
    const TipMotion before = motion;
    const double ahead = predict(rig, motion, at_ms(150)).xyz[0];
    correct_now(rig, at_ms(150), Vec<'W'>(0.010 - ahead, 0, 0), motion);
    EXPECT_NEAR(predict(rig, motion, at_ms(150)).xyz[0], 0.010, 1e-12);
    EXPECT_LT(motion.velocity.xyz[0], 0.08);
    EXPECT_LT(std::abs(motion.position.xyz[0] - before.position.xyz[0]), 1e-3);
    EXPECT_EQ(motion.position.xyz[1], before.position.xyz[1]);
    EXPECT_EQ(motion.along.vv, before.along.vv);
    EXPECT_EQ(motion.t, before.t);
  }
}

TEST(CorrectNow, NothingIsPredictedWhereNothingIsKnownOrAllIsHeld) {
  const TrackerRig hold = rig_with(Prediction::hold);
  TipMotion held = seen(hold);
  const TipMotion before = held;
  correct_now(hold, at_ms(150), Vec<'W'>(1e-3, 0, 0), held);
  EXPECT_EQ(held.position.xyz[0], before.position.xyz[0]);
  TipMotion nothing;
  correct_now(rig_with(Prediction::constant_velocity), at_ms(150), Vec<'W'>(1e-3, 0, 0), nothing);
  EXPECT_FALSE(nothing.position.finite());
  TipMotion motion = seen(rig_with(Prediction::constant_velocity));
  correct_now(rig_with(Prediction::constant_velocity), at_ms(150), Vec<'W'>(), motion);
  EXPECT_TRUE(motion.position.finite());
}

}  // namespace
}  // namespace enc
