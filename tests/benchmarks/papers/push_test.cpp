// Pushes from outside: force law, programme and tremor of the pusher, computed by hand; the criterion of
// instability; and the boundary of stability, which follows the linear theory where that theory holds.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "benchmarks/stiffness/push_study.h"
#include "benchmarks/stiffness/stiffness.h"
#include "sim/bodies/pusher.h"
#include "tests/support/built.h"
#include "tests/support/twin.h"

namespace enc::bench::stiffness {
namespace {

using sim::Phase;
using sim::Pusher;
using test::Twin;

constexpr double kStep = 1e-3;      // s
constexpr double kRadius = 0.005;   // m, of the tip
constexpr double kSurface = 0.005;  // m, height of the wall in W

PusherSpec programme() {
  PusherSpec spec;
  spec.ramp_time = 2.0;
  spec.hold_time = 3.0;
  spec.rest_time = 1.0;
  spec.repeats = 2;
  return spec;
}
sim::PusherTruth still() {
  sim::PusherTruth truth;
  truth.stiffness = 45.0;
  truth.damping = 1.0;
  truth.tremor = 0.0;
  return truth;
}
// A wall of 30 N/m with a requested depth of 15 mm, which is 0.45 N.
PushedPoint wall() { return {{Point<'W'>(0, 0, kSurface), Vec<'W'>(0, 0, 1)}, 0.015, 0.45}; }
Point<'W'> tip_at(double depth) { return {0, 0, kSurface - kRadius - depth}; }

// Simulates until `to` (s) with the tip at `depth`; returns the pressing force in N.
double press(Pusher& pusher, double& t, double to, double depth, double speed = 0.0) {
  double force = 0.0;
  for (; t < to - 0.5 * kStep; t += kStep)
    force = -pusher.act(t, kStep, tip_at(depth), Vec<'W'>(0, 0, -speed)).xyz[2];
  return force;
}

TEST(Pusher, SpringAndDamperWorkedByHand) {
  Pusher pusher(programme(), still(), wall(), kRadius, 1);
  EXPECT_DOUBLE_EQ(pusher.reach(), 0.015 + 0.45 / 45.0);
  double t = 0.0;
  EXPECT_EQ(press(pusher, t, 0.9, -1.0), 0.0);  // waits clear of the tip, wherever the tip is
  // The pusher is half-way through the ramp and the path from 2 mm above to 25 mm below, at 1.875 times the
  // mean speed.
  const double at = 0.5 * 0.027 - 0.002, speed = 1.875 * 0.027 / 2.0;
  EXPECT_NEAR(press(pusher, t, 2.0, 0.005), 45.0 * (at - 0.005) + speed, 1e-9);
  EXPECT_NEAR(press(pusher, t, 4.0, 0.015), 0.45, 1e-12);                // held: the wall's own force
  EXPECT_NEAR(press(pusher, t, 4.1, 0.015, 0.01), 0.45 - 0.01, 1e-12);   // the tip gives way
  EXPECT_NEAR(press(pusher, t, 4.2, 0.014), 0.45 + 45.0 * 1e-3, 1e-12);  // or resists
  EXPECT_EQ(press(pusher, t, 4.3, 0.026), 0.0);                          // it does not pull
}

TEST(Pusher, PushesAlongTheNormalAlone) {
  PushedPoint to = wall();
  to.at.normal = Vec<'W'>(0.6, 0, 0.8);
  Pusher pusher(programme(), still(), to, kRadius, 1);
  Vec<'W'> force;
  for (double t = 0.0; t < 4.0; t += kStep)
    force = pusher.act(t, kStep, to.at.point - (kRadius + 0.015) * to.at.normal, Vec<'W'>(0.8, 0, -0.6));
  EXPECT_NEAR((force.e() + 0.45 * to.at.normal.e()).norm(), 0.0, 1e-12);  // sideways motion is not damped
}

TEST(Pusher, RepeatsItsProgramme) {
  Pusher pusher(programme(), still(), wall(), kRadius, 1);
  double t = 0.0;
  for (int push = 0; push < 2; ++push)
    for (const auto& [phase, time] :
         {std::pair{Phase::wait, 1.0}, {Phase::press, 2.0}, {Phase::hold, 3.0}, {Phase::release, 2.0}}) {
      press(pusher, t, t + 0.5 * time, 0.0);
      EXPECT_EQ(pusher.state().phase, phase) << t;
      EXPECT_EQ(pusher.state().push, push);
      press(pusher, t, t + 0.5 * time, 0.0);
    }
  press(pusher, t, t + 0.1, 0.0);
  EXPECT_TRUE(pusher.done());
  EXPECT_EQ(press(pusher, t, t + 5.0, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(pusher.duration(), 2 * 8.0 + 1.0);
}

TEST(Pusher, TremorHasItsSizeAndRate) {
  PusherSpec spec = programme();
  spec.hold_time = 400.0;
  sim::PusherTruth truth = still();
  truth.tremor = 0.02;
  const auto forces = [&](std::uint64_t seed) {
    Pusher pusher(spec, truth, wall(), kRadius, seed);
    std::vector<double> all;
    for (double t = 0.0; t < 390.0; t += kStep) {
      const double force = -pusher.act(t, kStep, tip_at(0.015), Vec<'W'>::zero()).xyz[2];
      if (t > 3.0) all.push_back(force);
    }
    return all;
  };
  const std::vector<double> all = forces(1);
  double sum = 0.0;
  for (const double f : all) sum += (f - 0.45) * (f - 0.45);
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(all.size())), 0.02, 0.002);
  EXPECT_NEAR(bench::stiffness::strongest_frequency(std::span(all).first(20000), kStep), 8.1, 0.6);
  EXPECT_EQ(all, forces(1));
  EXPECT_NE(all, forces(2));
}

// The twin without errors: 1 N/mm, pushed 15 mm deep.
std::vector<std::string> exact() {
  return {"rig.force.tare=start",
          "rig.force.tare_time_s=0",
          "truth.force.torque_noise_Nm=0",
          "truth.force.torque_quantum_Nm=0",
          "rig.force.threshold_N=0",
          "truth.force.noise_N=0",
          "truth.force.quantum_N=0",
          "truth.force.zero_N=0",
          "truth.force.drift_N_per_push=0",
          "truth.force.drift_N_per_sqrt_s=0",
          "truth.pusher.tremor_N=0",
          "truth.hexapod.step_um=0",
          "truth.hexapod.repeatability_um=0"};
}

TEST(Pusher, FindsItsBalanceWithARenderedSpring) {
  Twin twin(exact(), 1, "stiffness");
  twin.run(8900);
  const sim::Truth& truth = twin.world->truth();
  EXPECT_EQ(truth.phase, Phase::hold);
  EXPECT_EQ(twin.out.mode, Mode::contact);  // the core detects the push from force alone, without a tracker
  EXPECT_EQ(twin.out.contacts, 1);
  EXPECT_NEAR(-truth.contact_force.xyz[2], 15.0, 1e-3);
  EXPECT_NEAR(twin.out.deflection, 0.015, 1e-6);
  const double weight = twin.setup.twin.hexapod.mass * 9.80665;
  EXPECT_NEAR(twin.in.wrench.value.force.xyz[2], truth.contact_force.xyz[2] - weight, 1e-4);
  EXPECT_NEAR(twin.in.wrench.value.torque.e().norm(), 0.0, 1e-4);  // straight above the sensor
}

TEST(Pusher, EndsAtItsForceWhereThatComesFirst) {
  std::vector<std::string> set = exact();
  set.emplace_back("behaviour.spring.stiffness_N_per_mm=100");
  Twin twin(set, 1, "stiffness");
  twin.run(8900);
  EXPECT_NEAR(-twin.world->truth().contact_force.xyz[2], 30.0, 0.05);
  EXPECT_NEAR(twin.out.deflection, 0.3e-3, 1e-6);
}

TEST(Pusher, TheZeroDriftsFromPushToPush) {
  Twin twin({"truth.force.drift_N_per_sqrt_s=0", "truth.force.drift_N_per_push=0.5", "pusher.repeats=2",
             "pusher.hold_s=0.5", "pusher.ramp_s=0.5"},
            1, "stiffness");
  twin.tick();
  const Vec3 first = twin.world->force->zero().e();
  twin.run(1800);
  const Vec3 second = twin.world->force->zero().e();
  twin.run(2500);
  const Vec3 third = twin.world->force->zero().e();
  EXPECT_GT((second - first).norm(), 0.05);
  EXPECT_GT((third - second).norm(), 0.05);
}

TEST(Pusher, GoesOnFromASavedState) {
  Twin twin({}, 1, "stiffness");
  twin.run(2500);
  const auto saved = twin.world->save();
  const auto later = [&] {
    for (int i = 0; i < 300; ++i) twin.world->advance();
    return twin.world->truth();
  };
  const sim::Truth once = later();
  twin.world->restore(saved);
  const sim::Truth again = later();
  EXPECT_LT(once.contact_force.xyz[2], 0.0);
  EXPECT_EQ(once.contact_force.xyz, again.contact_force.xyz);
  EXPECT_EQ(once.tip.xyz, again.tip.xyz);
  EXPECT_EQ(once.phase, again.phase);
}

constexpr double kPeriod = 1e-3;  // s

std::vector<double> swing(double amplitude, double frequency, double decay = 0.0, std::size_t n = 3000) {
  std::vector<double> way(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) * kPeriod;
    way[i] = 0.015 + amplitude * std::exp(-decay * t) * std::sin(2.0 * std::numbers::pi * frequency * t);
  }
  return way;
}
bool unstable(const std::vector<double>& way) {
  Push push;
  push.peak_to_peak = peak_to_peak(way);
  return push.unstable();
}

TEST(PushStudy, InstabilityIsSeenInTheMotion) {
  EXPECT_NEAR(peak_to_peak(swing(0.6e-3, 2.6)), 1.2e-3, 1e-6);
  EXPECT_TRUE(unstable(swing(0.51e-3, 2.6)));     // a limit cycle
  EXPECT_TRUE(unstable(swing(0.1e-3, 2.6, -1)));  // grows
  EXPECT_FALSE(unstable(swing(0.49e-3, 2.6)));
  EXPECT_FALSE(unstable(swing(0.0, 2.6)));
  const std::vector<double> dying = swing(5e-3, 2.6, 3.0, 6000);
  EXPECT_FALSE(unstable({dying.begin() + 3000, dying.end()}));  // comes to rest
  EXPECT_TRUE(unstable({}));                                    // never at rest
  EXPECT_TRUE(unstable({0.015, kUnset, 0.015}));
  EXPECT_TRUE(Push{}.unstable());
}

TEST(PushStudy, SteadyMeanDoesNotDependOnWhereASwingIsCut) {
  for (const double frequency : {1.7, 2.6, 5.3, 64.0})
    EXPECT_NEAR(steady_mean(swing(1e-3, frequency)), 0.015, 0.004 * 1e-3) << frequency;
  EXPECT_NEAR(steady_mean(std::vector<double>(1000, 2.5)), 2.5, 1e-12);
}

TEST(PushStudy, FindsTheStrongestFrequency) {
  for (const double frequency : {2.5, 8.0, 64.0})
    EXPECT_NEAR(strongest_frequency(swing(1e-3, frequency), kPeriod), frequency, 0.26);
  EXPECT_TRUE(std::isnan(strongest_frequency(std::vector<double>(1000, 2.5), kPeriod)));
}

TEST(PushStudy, SlopeOfAnAbsoluteForceErrorIsMinusOne) {
  std::vector<Level> levels;
  for (const double k : {30.0, 60.0, 300.0, 5000.0}) {
    Push push;
    push.stiffness = k;
    push.measured = k * (1.0 + 0.05 / (k * 0.015));
    push.load = k * 1.01;
    levels.push_back({k, {push, push}});
  }
  EXPECT_NEAR(error_slope(levels, &Push::measured, 30, 300), -1.0, 1e-9);
  EXPECT_NEAR(error_slope(levels, &Push::load, 30, 300), 0.0, 1e-9);
  EXPECT_NEAR(spread(levels[0], &Push::measured).worst(), 100.0 / 9.0, 1e-9);
}

models::Setup setup_with(const std::vector<std::string>& variant) {
  return push_setup(tests::source_dir() + "/models", {}, variant);
}

TEST(PushStudy, AForceErrorBecomesTheErrorThatItHasToBe) {
  // The threshold is 0.05 N at 0.1 N/mm: the pusher (k_h) finds x with k_h (x_s - x) = k x + 0.05.
  const models::Setup setup =
      with_stiffness(setup_with({"truth.pusher.tremor_N=0", "truth.force.drift_N_per_push=0"}), 100);
  const double k_h = setup.twin.pusher.stiffness;
  const double x = (k_h * 0.015 + 1.5 - 0.05) / (k_h + 100.0);
  const Push push = push_once(setup, 1);
  EXPECT_NEAR(push.error(push.measured), 100.0 * 0.05 / (100.0 * x), 0.02);
  EXPECT_FALSE(push.unstable());
}

TEST(PushStudy, TheLoadIsFreeOfTheZerosError) {
  const Push push = push_once(with_stiffness(setup_with({"truth.force.drift_N_per_push=0.3"}), 1000), 3);
  EXPECT_GT(std::abs(push.error(push.load) - push.error(push.measured)), 0.3);  // a zero that is 0.3 N off
  // x contains what the core took for pressing; the load does not. The two differ by zero / (k x).
  const Push exact = push_once(with_stiffness(setup_with({"truth.force.drift_N_per_push=0"}), 1000), 3);
  EXPECT_NEAR(exact.error(exact.load), exact.error(exact.measured), 0.05);
}

// Without saturation the boundary follows the linear loop, in its place and in the effect of each parameter.
TEST(PushStudy, BoundaryMovesAsTheLinearTheorySays) {
  const auto boundary = [](const std::vector<std::string>& change, double& linear) {
    std::vector<std::string> variant = unlimited_acceleration();
    variant.emplace_back("truth.pusher.stiffness_N_per_mm=1");
    variant.emplace_back("pusher.hold_s=4");
    variant.insert(variant.end(), change.begin(), change.end());
    const models::Setup setup = setup_with(variant);
    linear = lowest_stable_stiffness(pushed_loop(setup));
    return StabilityMap(setup, 1, 1, 1.0, 2.0).lowest_stable(linear);
  };
  double before_linear = 0.0;
  const double before = boundary({}, before_linear);
  EXPECT_NEAR(before / before_linear, 1.0, 0.15);
  struct Change {
    const char* set;
    bool up;
  };
  for (const Change& change :
       {Change{"truth.pusher.stiffness_N_per_mm=1.5", true},
        Change{"truth.pusher.stiffness_N_per_mm=0.6", false}, Change{"rig.force.filter_hz=8", true},
        Change{"truth.hexapod.delay_cycles=12", true}, Change{"truth.hexapod.servo_hz=25", false}}) {
    double linear = 0.0;
    const double after = boundary({change.set}, linear);
    EXPECT_EQ(after > before, change.up) << change.set;
    EXPECT_NEAR(after / before, linear / before_linear, 0.08 * linear / before_linear) << change.set;
  }
}

TEST(PushStudy, LowestStableIsFoundFromAnyGuess) {
  const models::Setup setup = setup_with({"pusher.hold_s=3"});
  StabilityMap map(setup, 7, 2, 1.0, 2.0);
  const double lowest = map.lowest_stable(30);
  EXPECT_GT(map.unstable_share(lowest - 2.0), 0.0);
  EXPECT_EQ(map.unstable_share(lowest), 0.0);
  EXPECT_EQ(StabilityMap(setup, 7, 2, 1.0, 2.0).lowest_stable(200), lowest);
  EXPECT_EQ(StabilityMap(setup, 7, 2, 1.0, 2.0).lowest_stable(5), lowest);
}

}  // namespace
}  // namespace enc::bench::stiffness
