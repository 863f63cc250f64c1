// A device's clock, tied to the loop's over a network that delays as it likes.
#include "hw_drivers/net/clock_tie.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

namespace enc::net {
namespace {

// A device that stamps a message each 10 ms, and a network of 0.2 ms at least and 1 ms more on average.
struct Device {
  double ahead = 3.0, drift = 50e-6;  // of its clock, at 0 s
  std::uint64_t seed = 1;
  ClockTie tie{from_seconds(kLeast)};
  std::mt19937_64 random{seed};
  double t = 0.0, late = 0.0;
  double worst = 0.0;     // of what it was told to be and what it was, s: since the last look
  double youngest = 0.0;  // s: by how much it was told to be younger than it was, at most

  static constexpr double kLeast = 0.2e-3, kPeriod = 0.01;
  [[nodiscard]] double says(double at) const { return 1700.0 + at + ahead + drift * at; }
  void run(double seconds_more) {
    std::exponential_distribution<double> more(1.0 / 1e-3);
    for (const double until = t + seconds_more; t < until; t += kPeriod) {
      const double arrives = 1700.0 + t + kLeast + more(random) + late;
      const Time here = tie.here(std::llround(1e9 * says(t)), Time(from_seconds(arrives)));
      const double off = seconds(here.time_since_epoch()) - 1700.0 - t;
      worst = std::max(worst, std::abs(off));
      youngest = std::max(youngest, off);
    }
  }
  double look() { return std::exchange(worst, 0.0); }
};

// All within what is promised, and nearly all within the spread that it says.
TEST(ClockTie, FindsOffsetAndDriftWithinThirtySeconds) {
  int within = 0;
  constexpr int kSeeds = 100;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Device device{.seed = seed};
    device.run(30.0);
    device.look();
    device.run(1.0);
    const ClockEstimate found = device.tie.estimate();
    const double ahead = 3.0 + 50e-6 * device.t;
    EXPECT_LT(std::abs(found.ahead - ahead), 0.1e-3) << seed;
    EXPECT_NEAR(found.drift, 50e-6, 5e-6) << seed;
    EXPECT_LT(found.spread, 0.1e-3) << seed;
    EXPECT_LT(device.look(), 0.1e-3) << seed;
    within += std::abs(found.ahead - ahead) <= found.spread ? 1 : 0;
  }
  EXPECT_GE(within, 95);
}

TEST(ClockTie, BothSignsOfBothAreFound) {
  for (const double ahead : {-3.0, 0.0, 3.0})
    for (const double drift : {-150e-6, 0.0, 150e-6}) {
      Device device{.ahead = ahead, .drift = drift};
      device.run(31.0);
      EXPECT_NEAR(device.tie.estimate().drift, drift, 5e-6);
      EXPECT_NEAR(device.tie.estimate().ahead, ahead + drift * device.t, 0.1e-3);
    }
}

TEST(ClockTie, SaysNothingOfADriftBeforeItCanKnowIt) {
  Device device;
  EXPECT_TRUE(std::isnan(device.tie.estimate().ahead));
  device.run(3.0);
  EXPECT_TRUE(std::isnan(device.tie.estimate().drift));
  EXPECT_NEAR(device.tie.estimate().ahead, 3.0, 1e-3);
}

// What it is told after a step forward is right but for what the first message was late by, and soon as good
// as before.
TEST(ClockTie, AClockThatIsSetForwardIsANewOne) {
  for (const double step : {0.05, 1.0, 3600.0}) {
    Device device;
    device.run(20.0);
    device.look();
    device.ahead += step;
    device.run(1.0);
    EXPECT_LT(device.look(), 12e-3) << step << " s: the first message was late, as any is";
    device.run(30.0);
    device.look();
    device.run(1.0);
    EXPECT_LT(device.look(), 0.1e-3) << step;
    EXPECT_EQ(device.tie.estimate().forward, 1) << step;
  }
}

// Also by less than what is called a step, and after a long time in which clocks may have parted.
TEST(ClockTie, AClockThatIsSetForwardByLittleIsFollowed) {
  for (const double step : {0.005, 0.015, 0.05, 0.5})
    for (const double after : {20.0, 200.0, 600.0, 3600.0}) {
      Device device;
      device.run(after);
      device.ahead += step;
      device.run(1.0);
      device.look();
      device.run(5.0);
      EXPECT_LT(device.look(), 0.5e-3) << step << " s after " << after;
      device.run(2.0);
      device.look();
      device.run(30.0);
      EXPECT_LT(device.look(), 0.2e-3) << step << " s after " << after;
      EXPECT_NEAR(device.tie.estimate().drift, 50e-6, 5e-6) << step << " s after " << after;
      EXPECT_LT(device.tie.estimate().spread, 0.1e-3);
    }
}

// As who reads the stamps says of one that is set back.
TEST(ClockTie, AClockThatIsSetBackIsForgotten) {
  Device device;
  device.run(20.0);
  device.ahead -= 2.0;
  device.tie.forget();
  device.run(31.0);
  device.look();
  device.run(1.0);
  EXPECT_LT(device.look(), 0.1e-3);
  EXPECT_EQ(device.tie.estimate().forward, 0);
}

// Set back while nothing came, so that no stamp goes back, or all on its way late from then on: nobody can
// tell, and what is old is never taken for fresh.
TEST(ClockTie, WhatMayBeADelayIsTakenForOneHoweverLongNothingCame) {
  for (const double silent : {0.0, 3.0, 33.0, 300.0}) {
    Device device{.drift = 0.0};
    device.run(20.0);
    device.t += silent;
    device.late = 0.3;
    device.run(2.0);
    EXPECT_LT(device.youngest, 0.2e-3 + 200e-6 * (silent + 5.0)) << silent;
  }
}

// 50 ms more on the way, for as long as it likes: the clock is where it was, and parts no faster than
// crystals do. When the delay is over it is no clock that was set forward.
TEST(ClockTie, ADelayThatLastsIsNoClock) {
  for (const int lasts : {60, 150, 400}) {
    Device device{.drift = 0.0};
    device.run(20.0);
    device.late = 0.05;
    for (int i = 0; i < lasts; ++i) {
      device.run(1.0);
      EXPECT_LT(device.look(), 0.2e-3 + std::min(0.06, 200e-6 * (i + 1.5))) << i;
    }
    if (lasts < 200) {
      EXPECT_GT(device.tie.estimate().spread, 5e-3) << "and it says that it knows it badly";
    }
    device.late = 0.0;
    device.run(1.0);
    device.look();
    device.run(1.0);
    EXPECT_LT(device.look(), 0.5e-3) << "again at once, but for the slope";
    device.run(40.0);
    device.look();
    device.run(1.0);
    EXPECT_LT(device.look(), 0.1e-3);
    EXPECT_EQ(device.tie.estimate().forward, 0) << lasts;
  }
}

// What is wrong with the least delay is wrong with the offset, and no spread tells.
TEST(ClockTie, ALeastDelayThatIsNotTrueIsWrongWithTheOffset) {
  Device device;
  device.tie = ClockTie(Duration{});
  device.run(31.0);
  EXPECT_NEAR(device.tie.estimate().ahead, 3.0 + 50e-6 * device.t - Device::kLeast, 0.05e-3);
}

TEST(ClockTie, SaysInWordsWhatItKnows) {
  EXPECT_EQ(words({}), "");
  EXPECT_EQ(words({.ahead = -0.5}), "its clock is 0.5000 s behind the run's");
  EXPECT_EQ(words({.ahead = 3.0, .drift = 50e-6, .spread = 2e-5, .forward = 2}),
            "its clock is 3.0000 s ahead of the run's, 50.0 ppm fast; half of its quickest messages lie "
            "within 0.020 ms of "
            "that; it was set forward 2 times");
}

}  // namespace
}  // namespace enc::net
