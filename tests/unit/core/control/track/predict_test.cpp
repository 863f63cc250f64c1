// The prediction of the tool's tip: the filter against matrices and hand-worked gains, its limits, and late,
// repeated, lost and impossible poses.
#include "core/control/track/predict.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/control/track/markers.h"
#include "core/record/state_hash.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

constexpr Duration kMs{1'000'000};
Time after_ms(int ms) { return Time(ms * kMs); }

TrackerRig rig_of(Prediction prediction) {
  TrackerRig rig;
  rig.prediction = prediction;
  return rig;
}
const TrackerRig kHold = rig_of(Prediction::hold);
const TrackerRig kVelocity = rig_of(Prediction::constant_velocity);
const TrackerRig kAcceleration = rig_of(Prediction::constant_acceleration);

// A tracker with equal noise in all directions.
void observe(const TrackerRig& rig, std::int32_t tool, Time t, const Point<'W'>& tip, TipMotion& motion,
             bool calm = false) {
  enc::observe(rig, tool, t, tip, {rig.measurement_noise, rig.measurement_noise}, motion, calm);
}

// A pose every 10 ms until `end`, each without latency.
template <class Way>
TipMotion tracked(const TrackerRig& rig, const Way& way, int end) {
  TipMotion motion;
  for (int ms = 0; ms <= end; ms += 10)
    observe(rig, 0, after_ms(ms), Point<'W'>(way(1e-3 * ms), 0, 0), motion);
  return motion;
}
double x_at(const TrackerRig& rig, const TipMotion& motion, int ms) {
  return predict(rig, motion, after_ms(ms)).xyz[0];
}

// Second pose, 10 ms after the first, 1 mm on. By hand, with r = 0.015 mm, 0.3 m/s rms, q = 0.055^2 m^2/s^3:
//   P = r^2 + 0.09 * 1e-4 + q * 1e-6 / 3 = 9.001233e-6,  with the velocity 9e-4 + q * 1e-4 / 2 = 9.0015125e-4
//   S = P + r^2 = 9.001458e-6;  K = P / S = 0.9999750,  K_v = 100.0006 / s
TEST(Predict, GainsOfTheSecondPoseAreThoseWorkedByHand) {
  TipMotion motion;
  observe(kVelocity, 0, after_ms(0), Point<'W'>(0, 0, 0), motion);
  observe(kVelocity, 0, after_ms(10), Point<'W'>(1e-3, 0, 0), motion);
  EXPECT_NEAR(motion.position.xyz[0], 0.9999750e-3, 1e-10);
  EXPECT_NEAR(motion.velocity.xyz[0], 0.1000006, 1e-7);
  EXPECT_EQ(motion.velocity.xyz[1], 0.0);
  EXPECT_EQ(motion.acceleration.xyz[0], 0.0);
}

// The filter written with matrices.
struct Matrices {
  Mat3 P;
  Vec3 x;
  void step(const TrackerRig& rig, double h, double z) {
    Mat3 F = Mat3::Identity();
    F << 1, h, h * h / 2, 0, 1, h, 0, 0, 1;
    Mat3 Q = Mat3::Zero();
    if (rig.prediction == Prediction::constant_velocity) {
      F(0, 2) = F(1, 2) = 0.0;
      Q.topLeftCorner<2, 2>() << h * h * h / 3, h * h / 2, h * h / 2, h;
      Q *= rig.acceleration_noise * rig.acceleration_noise;
    } else {
      Q << std::pow(h, 5) / 20, std::pow(h, 4) / 8, std::pow(h, 3) / 6,  //
          std::pow(h, 4) / 8, std::pow(h, 3) / 3, h * h / 2,             //
          std::pow(h, 3) / 6, h * h / 2, h;
      Q *= rig.jerk_noise * rig.jerk_noise;
    }
    x = F * x;
    P = F * P * F.transpose() + Q;
    const Vec3 K = P.col(0) / (P(0, 0) + rig.measurement_noise * rig.measurement_noise);
    x += K * (z - x(0));
    P = (Mat3::Identity() - K * Vec3::UnitX().transpose()) * P;
  }
};

TEST(Predict, IsTheKalmanFilterThatMatricesGive) {
  for (const TrackerRig& rig : {kVelocity, kAcceleration}) {
    TipMotion motion;
    observe(rig, 0, after_ms(0), Point<'W'>(0, 0, 0), motion);
    Matrices other{Vec3(motion.across.xx, motion.across.vv, motion.across.aa).asDiagonal(), Vec3::Zero()};
    int before = 0;
    for (const int ms : {8, 17, 33, 42, 50, 100, 108, 117}) {
      const double z = 2e-3 * std::sin(0.02 * ms);
      observe(rig, 0, after_ms(ms), Point<'W'>(z, 0, 0), motion);
      other.step(rig, 1e-3 * (ms - before), z);
      before = ms;
      EXPECT_NEAR(motion.position.xyz[0], other.x(0), 1e-15);
      EXPECT_NEAR(motion.velocity.xyz[0], other.x(1), 1e-13);
      EXPECT_NEAR(motion.acceleration.xyz[0], other.x(2), 1e-11);
      EXPECT_NEAR(motion.across.xx / other.P(0, 0), 1.0, 1e-9);
      EXPECT_NEAR(motion.across.xv / other.P(0, 1), 1.0, 1e-9);
      EXPECT_NEAR(motion.across.vv / other.P(1, 1), 1.0, 1e-9);
    }
  }
}

// A hand as vision sees it: 20 Hz, 0.5 mm.
TrackerRig seen_hand(double surprise) {
  TrackerRig rig = kVelocity;
  rig.measurement_noise = 0.5e-3;
  rig.acceleration_noise = 0.02;
  rig.surprise_noise = surprise;
  rig.longest_prediction = 0.2;
  rig.usual_age = 0.11;
  return rig;
}
TipMotion stopped(const TrackerRig& rig, bool calm) {
  TipMotion motion;
  for (int ms = 0; ms <= 1050; ms += 50)  // 200 mm/s for a second, then no more
    observe(rig, 0, after_ms(ms), Point<'W'>(0.2e-3 * std::min(ms, 1000), 0, 0), motion, calm);
  return motion;
}

TEST(Predict, ASurpriseMakesUpForASpeedThatChanges) {
  const double without = stopped(seen_hand(0.0), false).velocity.xyz[0];
  const double with = stopped(seen_hand(1.0), false).velocity.xyz[0];
  EXPECT_GT(without, 0.10);  // assumes its 200 mm/s
  EXPECT_LT(with, 0.05);     // 10 mm off with a sigma of 0.5 mm: the hand has stopped
  EXPECT_EQ(stopped(seen_hand(1.0), true).velocity.xyz[0], without);  // on a prop: no surprise
}

// 10 mm off, S = xx + r^2 before. The noise rises until S is a third of the square of 10 mm (three axes), so
// the velocity's variance grows by q h and its gain with it.
TEST(Predict, ASurpriseRaisesTheNoiseByWhatExplainsIt) {
  const TrackerRig rig = seen_hand(100.0);
  TipMotion motion;
  for (int ms = 0; ms <= 1000; ms += 50) observe(rig, 0, after_ms(ms), Point<'W'>(0, 0, 0), motion);
  const double h = 0.05, q0 = 0.02 * 0.02, r2 = 0.25e-6, found = 1e-4;
  const double xx = motion.across.xx + 2.0 * h * motion.across.xv + h * h * motion.across.vv;
  const double xv = motion.across.xv + h * motion.across.vv;
  const double s = xx + q0 * h * h * h / 3.0 + r2;
  ASSERT_GT(found, 9.0 * s);
  const double q = q0 + (found / 3.0 - s) * 3.0 / (h * h * h);
  const double gain = (xv + q * h * h / 2.0) / (found / 3.0);
  observe(rig, 0, after_ms(1050), Point<'W'>(0.01, 0, 0), motion);
  EXPECT_NEAR(motion.velocity.xyz[0], gain * 0.01, 1e-9);
}

// A camera is less accurate along its view: the filter uses the greater noise there and the lesser one to the
// sides. The direction of the view in W makes no difference.
TEST(Predict, EachWayIsFilteredByItsOwnNoise) {
  constexpr double kAlong = 1.5e-3, kAcross = 0.3e-3;
  const TrackerRig rig = seen_hand(0.3);
  TrackerRig deep = rig, wide = rig;
  deep.measurement_noise = kAlong;
  wide.measurement_noise = kAcross;
  const Quat turned(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  TipMotion motion, along, across, oblique;
  for (int ms = 0; ms <= 1000; ms += 50) {
    const double x = 0.3e-3 * std::sin(0.3 * ms), z = 0.1e-3 * ms + 1.2e-3 * std::cos(0.4 * ms);
    const TipNoise noise{kAlong, kAcross, Vec<'W'>(0, 0, 1)};
    enc::observe(rig, 0, after_ms(ms), Point<'W'>(x, 0, z), noise, motion);
    enc::observe(rig, 0, after_ms(ms), Point<'W'>(Vec3(turned * Vec3(x, 0, z))),
                 {kAlong, kAcross, Vec<'W'>(Vec3(turned * Vec3(0, 0, 1)))}, oblique);
    observe(deep, 0, after_ms(ms), Point<'W'>(0, 0, z), along);
    observe(wide, 0, after_ms(ms), Point<'W'>(x, 0, 0), across);
  }
  EXPECT_NEAR(motion.velocity.xyz[2], along.velocity.xyz[2], 1e-12);
  EXPECT_NEAR(motion.velocity.xyz[0], across.velocity.xyz[0], 1e-12);
  EXPECT_NEAR(motion.position.xyz[2], along.position.xyz[2], 1e-12);
  EXPECT_GT(motion.along.xx, 2.0 * motion.across.xx);
  EXPECT_LT((oblique.velocity.e() - turned * motion.velocity.e()).norm(), 1e-12);
  EXPECT_LT((oblique.position.e() - turned * motion.position.e()).norm(), 1e-12);
}

// The noise along the view from C, in W, if the pose states it; otherwise the rig's noise in every direction.
TEST(Predict, TheNoiseOfAPoseIsToldOrBelieved) {
  const Quat turned(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  const Pose<'W', 'C'> X_WC(turned, Vec3(0.1, -0.2, 0.3));
  TrackedTool pose{0, Pose<'C', 'T'>(Quat::Identity(), Vec3(0.03, 0.04, 0.5)), 2e-3, 0.5e-3};
  const TipNoise told = noise_of(kVelocity, pose, X_WC);
  EXPECT_EQ(told.along, 2e-3);
  EXPECT_EQ(told.across, 0.5e-3);
  EXPECT_LT((told.view.e() - turned * Vec3(0.03, 0.04, 0.5).normalized()).norm(), 1e-12);
  EXPECT_NEAR(told.mean_square(), (4.0 + 2.0 * 0.25) / 3.0 * 1e-6, 1e-18);
  pose.along = pose.across = kUnset;
  const TipNoise believed = noise_of(kVelocity, pose, X_WC);
  EXPECT_EQ(believed.along, kVelocity.measurement_noise);
  EXPECT_EQ(believed.across, kVelocity.measurement_noise);
  EXPECT_EQ(believed.view.norm(), 0.0);
}

// 5 mm off is at least four sigma across the view, and usual along it.
TEST(Predict, WhatSurprisesDependsOnTheWay) {
  const auto speed_after = [](const Vec3& off) {
    TipMotion motion;
    for (int ms = 0; ms <= 1000; ms += 50)
      enc::observe(seen_hand(0.3), 0, after_ms(ms), Point<'W'>(0, 0, 0), {3e-3, 0.5e-3, Vec<'W'>(0, 0, 1)},
                   motion);
    enc::observe(seen_hand(0.3), 0, after_ms(1050), Point<'W'>(off), {3e-3, 0.5e-3, Vec<'W'>(0, 0, 1)},
                 motion);
    return motion.velocity.norm();
  };
  EXPECT_GT(speed_after(Vec3(5e-3, 0, 0)), 0.04);
  EXPECT_LT(speed_after(Vec3(0, 0, 5e-3)), 0.01);
  EXPECT_GT(speed_after(Vec3(3.3e-3, 0, 0)), 0.03);  // less than the noise along, and a surprise across
}

TEST(Predict, WhatIsUsualIsNoSurprise) {
  TipMotion with, without;
  for (int ms = 0; ms <= 2000; ms += 50) {
    const Point<'W'> seen(0.5e-3 * std::sin(0.3 * ms), 0.5e-3 * std::cos(0.4 * ms), 0.1e-3 * ms);
    observe(seen_hand(1.0), 0, after_ms(ms), seen, with);
    observe(seen_hand(0.0), 0, after_ms(ms), seen, without);
    EXPECT_EQ(with.position.xyz, without.position.xyz);
    EXPECT_EQ(with.velocity.xyz, without.velocity.xyz);
  }
}

TEST(Predict, EachModelEndsUpExactOnItsOwnMotion) {
  const auto even = [](double t) { return 0.04 * t; };
  const auto speeding = [](double t) { return 0.1 * t * t; };
  EXPECT_NEAR(x_at(kVelocity, tracked(kVelocity, even, 2000), 2020), even(2.020), 1e-9);
  EXPECT_NEAR(x_at(kAcceleration, tracked(kAcceleration, even, 2000), 2020), even(2.020), 1e-9);
  EXPECT_NEAR(x_at(kAcceleration, tracked(kAcceleration, speeding, 2000), 2020), speeding(2.020), 1e-9);
  // Hold lags by the age; constant velocity never learns the acceleration.
  EXPECT_EQ(x_at(kHold, tracked(kHold, even, 2000), 2020), even(2.0));
  EXPECT_GT(std::abs(x_at(kVelocity, tracked(kVelocity, speeding, 2000), 2020) - speeding(2.020)), 1e-5);
}

TEST(Predict, WithoutNoiseThePoseIsTheTruth) {
  TrackerRig rig = kVelocity;
  rig.measurement_noise = 0.0;
  const TipMotion motion = tracked(
      rig, [](double t) { return std::sin(9.0 * t); }, 500);
  EXPECT_NEAR(motion.position.xyz[0], std::sin(4.5), 1e-15);
}

TEST(Predict, GoesOnFor100MsThenComesToRestWithin200) {
  const auto way = [](double t) { return 0.04 * t; };
  const TipMotion motion = tracked(kVelocity, way, 1000);
  EXPECT_NEAR(x_at(kVelocity, motion, 1100), way(1.1), 1e-7);
  double before = way(1.1), speed = 0.04;
  for (int ms = 1101; ms <= 1200; ++ms) {
    const double x = x_at(kVelocity, motion, ms);
    EXPECT_LE((x - before) / 1e-3, speed + 1e-9) << ms;  // never faster again
    EXPECT_GE(x, before) << ms;                          // and never back
    speed = (x - before) / 1e-3;
    before = x;
  }
  EXPECT_EQ(x_at(kVelocity, motion, 1200), x_at(kVelocity, motion, 9000));
  EXPECT_NEAR(x_at(kVelocity, motion, 9000), way(1.150), 1e-7);  // half of the speed on average
}

TEST(Predict, AfterALongSilenceNothingIsLeftOfTheSpeed) {
  TipMotion motion = tracked(
      kVelocity, [](double t) { return 0.04 * t; }, 1000);
  observe(kVelocity, 0, after_ms(1101), Point<'W'>(0.05, 0, 0), motion);
  EXPECT_EQ(motion.velocity.xyz[0], 0.0);
  EXPECT_EQ(motion.position.xyz[0], 0.05);
}

TEST(Predict, ALeapOrAnotherToolBeginsAnew) {
  for (const auto& [tool, x] : {std::pair{0, 0.5}, std::pair{1, 0.0401}}) {
    TipMotion motion = tracked(
        kVelocity, [](double t) { return 0.04 * t; }, 1000);
    observe(kVelocity, tool, after_ms(1010), Point<'W'>(x, 0, 0), motion);
    EXPECT_EQ(motion.tool, tool);
    EXPECT_EQ(motion.position.xyz[0], x);
    EXPECT_EQ(motion.velocity.xyz[0], 0.0);
  }
}

TEST(Predict, IsAtTheDataAtOnceAfterADropOut) {
  for (const int silence : {60, 99, 150, 500}) {
    TipMotion motion = tracked(
        kVelocity, [](double t) { return 0.04 * t; }, 1000);
    const int now = 1000 + silence;
    const double seen = x_at(kVelocity, motion, now) + 0.004;
    observe(kVelocity, 0, after_ms(now), Point<'W'>(seen, 0, 0), motion);
    EXPECT_NEAR(x_at(kVelocity, motion, now), seen, 0.1e-3) << silence;
  }
}

TEST(Predict, StampsThatAreLateAreTakenBack) {
  TrackerRig rig = kVelocity;
  rig.stamp_late = 0.003;
  EXPECT_EQ(exposed(rig, after_ms(10)), after_ms(7));
}

// ---- in the core
// ---------------------------------------------------------------------------------------------------

// A tool that moves at 40 mm/s along x above the ball, each pose 20 ms old; another one every `every` ticks.
struct MovingTool {
  test::Loop loop{prepare(test::ball_scene(), RigSpec{})};
  int ms = 0;
  bool older = false;
  [[nodiscard]] static Point<'W'> truth(int at) { return {0.04e-3 * at, 0, 0.03}; }
  void tick(int every = 10) {
    const Point<'W'> tip = truth(ms);
    loop.spoil = [this, every](Inputs& in) {
      const int then = (ms - 20) / every * every;
      in.tool.t = loop.k.t - (ms - then) * kMs;
      const Tool& tool = loop.scene.tools.front();
      const Vec3 markers = truth(then).e() - tool.tip.centre.e();
      in.tool.value.X_CT = loop.scene.X_WC.inverse() * Pose<'W', 'T'>(Quat::Identity(), markers);
      if (!older || ms % 10 < 3) return;
      in.tool.t -= ms * kMs / 10;
      in.tool.value.X_CT.xyz[0] += 0.001;
    };
    loop.tool_tip = tip;
    loop.tick();
    ++ms;
  }
};

TEST(PredictInTheCore, TheToolIsWhereItIsNowAndItsPoseGoesWithItsTip) {
  MovingTool moving;
  moving.loop.tick(50);
  moving.ms = 50;
  for (int i = 0; i < 1000; ++i) moving.tick();
  const View& view = moving.loop.out.view;
  EXPECT_NEAR((view.tip - MovingTool::truth(moving.ms - 1)).norm(), 0.0, 1e-6);
  const Point<'W'> tip = view.X_WT * moving.loop.scene.tools.front().tip.centre;
  EXPECT_NEAR((tip - view.tip).norm(), 0.0, 1e-15);
}

TEST(PredictInTheCore, OldAndRepeatedPosesChangeNothing) {
  MovingTool plain;      // each pose ten times over
  MovingTool disturbed;  // and in between one that is older and elsewhere
  disturbed.older = true;
  for (MovingTool* const moving : {&plain, &disturbed}) {
    moving->loop.tick(50);
    moving->ms = 50;
  }
  for (int i = 0; i < 400; ++i) {
    plain.tick();
    disturbed.tick();
    StateHash a;
    StateHash b;
    add_tick(a, plain.loop.state, plain.loop.out);
    add_tick(b, disturbed.loop.state, disturbed.loop.out);
    ASSERT_EQ(a.value, b.value) << i;
  }
}

// Down at 100 mm/s onto the haptic-tip, where it stops. Poses are 20 ms old: the tool would go 2 mm on.
TEST(PredictInTheCore, TheToolIsNotSeenToGoThroughTheHapticTip) {
  test::Loop loop(prepare(test::plane_scene(), RigSpec{}));
  const double touch = test::kTop + test::kToolRadius;
  const auto height = [&](int ms) { return std::max(touch, 0.040 - 1e-4 * std::max(0, ms - 500)); };
  double nearest = 1.0;
  for (int ms = 0; ms < 1200; ++ms) {
    loop.spoil = [&](Inputs& in) {
      const int then = std::max(0, ms - 20);
      const Vec3 markers = Vec3(0, 0, height(then)) - loop.scene.tools.front().tip.centre.e();
      in.tool.t = loop.k.t - (ms - then) * kMs;
      in.tool.value.X_CT = loop.scene.X_WC.inverse() * Pose<'W', 'T'>(Quat::Identity(), markers);
    };
    loop.tick();
    const Point<'W'> tip = loop.scene.X_WR * loop.in.tip.value.X_RH.origin();
    if (ms > 100) nearest = std::min(nearest, (loop.out.view.tip - tip).norm());
  }
  EXPECT_EQ(loop.out.mode, Mode::contact);
  EXPECT_LT(nearest, 0.0071);        // they met: 5 mm and 2 mm
  EXPECT_GT(nearest, 0.007 - 2e-4);  // less than the filter's own overshoot
}

TEST(PredictInTheCore, APoseThatIsNoPoseIsNotTakenIn) {
  MovingTool moving;
  moving.loop.tick(50);
  moving.ms = 50;
  for (int i = 0; i < 200; ++i) moving.tick();
  TipMotion before = moving.loop.state.tip_motion;
  Inputs in = moving.loop.in;
  Outputs out;
  in.tool.t += 5 * kMs;
  in.tool.value.X_CT.xyz[1] = kUnset;
  step(moving.loop.scene, moving.loop.k, in, moving.loop.state, out);
  EXPECT_NE(out.why & kToolInvalid, 0U);
  StateHash a;
  StateHash b;
  fields(a, before);
  fields(b, moving.loop.state.tip_motion);
  EXPECT_EQ(a.value, b.value);
  EXPECT_TRUE(out.view.tip.finite());
}

// A correction of the prediction by a source that is better than pictures.

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

// The tip is stopped: place and velocity follow, their uncertainty stays, and the sides do not change.
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

// Tools by their markers: identity, orientation, and tools that look alike.

using Markers = std::vector<Vec3>;

// The shipped marker sets (models/scenes/session.toml).
const Markers kStylus{{0, 0, 0}, {0.052, 0, 0}, {0, 0.041, 0}, {-0.017, -0.030, 0.012}};
const Markers kProbe{{0, 0, 0}, {0.061, 0, 0}, {0, 0.034, 0}, {-0.025, -0.022, 0.008}};
const std::vector<Markers> kBoth{kStylus, kProbe};

struct PoseGenerator {
  explicit PoseGenerator(std::uint64_t seed) : random(seed) {}
  double normal() { return normal_(random); }
  Pose<'C', 'T'> pose() {
    const Quat q = Quat(normal(), normal(), normal(), normal()).normalized();
    return {q, Vec3(0.2 * normal(), 0.2 * normal(), 1.0 + 0.1 * normal())};
  }
  // The markers as a tracker sees them, in any order.
  Markers seen(const Markers& tool, const Pose<'C', 'T'>& X_CT, double noise) {
    Markers all;
    for (const Vec3& marker : tool)
      all.push_back((X_CT * Point<'T'>(marker)).e() + noise * Vec3(normal(), normal(), normal()));
    std::shuffle(all.begin(), all.end(), random);
    return all;
  }
  std::mt19937_64 random;
  std::normal_distribution<double> normal_;
};

TEST(Markers, AToolIsRecognisedWithItsPoseInWhateverOrderTheyAreSeen) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    PoseGenerator drawn(seed);
    const auto which = static_cast<std::size_t>(seed % 2);
    const Pose<'C', 'T'> X_CT = drawn.pose();
    const RecognisedTool found = recognise(drawn.seen(kBoth[which], X_CT, 0.0), kBoth);
    ASSERT_EQ(found.tool, static_cast<std::int32_t>(which)) << seed;
    EXPECT_LT((found.X_CT.p() - X_CT.p()).norm(), 1e-12);
    EXPECT_LT(found.X_CT.q().angularDistance(X_CT.q()), 1e-7);
    EXPECT_LT(found.rms, 1e-12);
  }
}

// Noise of 0.3 mm on each axis of each marker causes no missed and no confused tool.
TEST(Markers, NoiseOfATrackerConfusesNone) {
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
    PoseGenerator drawn(seed);
    const auto which = static_cast<std::size_t>(seed % 2);
    wrong += recognise(drawn.seen(kBoth[which], drawn.pose(), 0.3e-3), kBoth).tool == static_cast<int>(which)
                 ? 0
                 : 1;
  }
  EXPECT_EQ(wrong, 0);
}

TEST(Markers, WhatIsNoneOfThemIsNotRecognised) {
  PoseGenerator drawn(1);
  Markers other = kStylus;
  other[1].x() += 2 * kMarkersApart;
  EXPECT_EQ(recognise(drawn.seen(other, drawn.pose(), 0.0), kBoth).tool, -1);
  Markers three(kStylus.begin(), kStylus.begin() + 3);
  EXPECT_EQ(recognise(three, kBoth).tool, -1) << "one is hidden";
  EXPECT_EQ(recognise({}, kBoth).tool, -1);
  EXPECT_EQ(recognise(Markers(17, Vec3::Zero()), kBoth).tool, -1);
}

// A mirror image has the same distances: it fits badly, and prepare() refuses a scene that names both.
TEST(Markers, AMirrorImageIsAlikeAndFitsBadly) {
  Markers mirrored = kStylus;
  for (Vec3& marker : mirrored) marker.z() = -marker.z();
  EXPECT_TRUE(alike(kStylus, mirrored));
  EXPECT_FALSE(alike(kStylus, kProbe));
  const std::vector<Markers> hands{kStylus, mirrored};
  PoseGenerator drawn(3);
  for (const int which : {0, 1})
    EXPECT_EQ(recognise(drawn.seen(hands[static_cast<std::size_t>(which)], drawn.pose(), 0.0), hands).tool,
              which);
}

// A mirror image alone does not pass as the tool either: its best fit is 4.9 mm off the stylus, 3.3 mm off
// the probe.
TEST(Markers, AMirrorImageAloneIsNone) {
  for (const Markers& tool : kBoth) {
    Markers mirrored = tool;
    for (Vec3& marker : mirrored) marker.x() = -marker.x();
    ASSERT_TRUE(alike(tool, mirrored));
    for (std::uint64_t seed = 1; seed <= 2'000; ++seed) {
      PoseGenerator drawn(seed);
      EXPECT_EQ(recognise(drawn.seen(mirrored, drawn.pose(), kMarkerNoise), kBoth).tool, -1) << seed;
    }
  }
}

// Each distance is off by less than 4 mm, and so is each marker: by 5 % of its distance from the middle, 1.8
// mm rms.
TEST(Markers, AToolOfWhichAllDistancesAreALittleOffIsNone) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& marker : kStylus) middle += marker / static_cast<double>(kStylus.size());
  const auto grown = [&](double by) {
    Markers all = kStylus;
    for (Vec3& marker : all) marker += by * (marker - middle);
    return all;
  };
  PoseGenerator drawn(2);
  ASSERT_TRUE(alike(kStylus, grown(0.05)));
  EXPECT_EQ(recognise(drawn.seen(grown(0.05), drawn.pose(), 0.0), kBoth).tool, -1);
  const RecognisedTool near = recognise(drawn.seen(grown(0.04), drawn.pose(), 0.0), kBoth);
  EXPECT_EQ(near.tool, 0);
  EXPECT_LT(near.rms, kWorstFit);
}

TEST(Markers, AToolThatLooksTheSameInAnotherOrderHasTwoPoses) {
  EXPECT_FALSE(has_two_poses(kStylus));
  EXPECT_FALSE(has_two_poses(kProbe));
  const double side = 0.05;
  EXPECT_TRUE(has_two_poses(Markers{{0, 0, 0}, {side, 0, 0}, {0, side, 0}})) << "its legs are alike";
  EXPECT_TRUE(has_two_poses(Markers{{0, 0, 0}, {side, 0, 0}, {0, side + 0.9 * kMarkersApart, 0}}));
  EXPECT_FALSE(has_two_poses(Markers{{0, 0, 0}, {side, 0, 0}, {0, side + 1.1 * kMarkersApart, 0}}));
}

// As many markers as a scene may have, all within 3 mm: there are 16! orders, and two are enough.
TEST(Markers, ManyThatLookAlikeAreFoundAtOnce) {
  PoseGenerator drawn(5);
  Markers many;
  for (std::size_t i = 0; i < kMostMarkers; ++i)
    many.emplace_back(1e-3 * std::cos(0.4 * static_cast<double>(i)),
                      1e-3 * std::sin(0.4 * static_cast<double>(i)), 0);
  EXPECT_TRUE(has_two_poses(many));
  EXPECT_TRUE(alike(many, drawn.seen(many, drawn.pose(), 0.0)));
}

}  // namespace
}  // namespace enc
