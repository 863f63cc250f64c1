// The rate of a box's counter, out of records that come late, twice or in bursts.
#include "hw_drivers/netft/drive/counter_rate.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace enc::netft {
namespace {

// Records for 0.4 s, one a millisecond; each comes up to `late` s later than it is sent, and in order.
CounterRate watched(double rate, double late, double set = 0.0, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> delay(0.0, late);
  CounterRate of(set);
  double before = 0.0;
  for (int n = 0; n < 400; ++n) {
    const double sent = 1e-3 * n;
    before = std::max(before, sent + delay(random));
    of.take(0xfffff000U + static_cast<std::uint32_t>(rate * sent), from_seconds(10.0 + before));
  }
  return of;
}

TEST(NetftCounterRate, EachKnownBoxIsKnownWhateverTheNetwork) {
  for (const double rate : {7000.0, 488.28125, 976.5625, 1953.125, 3906.25, 7812.5})
    for (const double late : {0.0, 1e-3, 5e-3}) {
      EXPECT_EQ(watched(rate, late).known(), rate) << late;
      EXPECT_NEAR(watched(rate, late).measured(), rate, 0.01 * rate) << late;
    }
}

// Sampled at 1 kHz in bursts of 50 ms: what a busy processor makes of it.
TEST(NetftCounterRate, BurstsDoNotChangeIt) {
  CounterRate of;
  for (int n = 0; n < 400; ++n)
    of.take(static_cast<std::uint32_t>(3.90625 * n), from_seconds(1e-3 * (n + 49 - n % 50)));
  EXPECT_EQ(of.known(), 3906.25);
}

TEST(NetftCounterRate, AnUnknownOneIsMeasuredAndIsKnownWhereItIsSet) {
  for (const double rate : {1000.0, 4000.0, 5000.0, 8000.0}) {
    EXPECT_TRUE(std::isnan(watched(rate, 1e-3).known())) << rate;
    EXPECT_NEAR(watched(rate, 1e-3).measured(), rate, 0.01 * rate);
    EXPECT_EQ(watched(rate, 1e-3, rate).known(), rate);
  }
  EXPECT_TRUE(std::isnan(watched(3906.25, 1e-3, 7000.0).known())) << "not what the rig file has";
}

// A box that is 0.7 % slow gives records that grow older by 7 ms each second.
TEST(NetftCounterRate, AlmostAKnownOneIsNotKnown) {
  for (const double rate : {6950.0, 7050.0, 3880.0})
    EXPECT_TRUE(std::isnan(watched(rate, 1e-3).known())) << rate;
  EXPECT_TRUE(std::isnan(watched(6950.0, 1e-3, 7000.0).known()));
  EXPECT_EQ(watched(6950.0, 1e-3, 6950.0).known(), 6950.0);
  EXPECT_EQ(watched(7000.7, 5e-3).known(), 7000.0) << "a quartz";
}

TEST(NetftCounterRate, WithoutRecordsOrWithACounterThatStandsThereIsNone) {
  EXPECT_TRUE(std::isnan(CounterRate().known()));
  EXPECT_EQ(CounterRate().watched(), 0.0);
  EXPECT_TRUE(std::isnan(watched(0.0, 1e-3).known()));
}

TEST(NetftCounterRate, IsPrintedInGroups) {
  EXPECT_EQ(grouped(7000.0), "7,000");
  EXPECT_EQ(grouped(3906.25), "3,906");
  EXPECT_EQ(grouped(488.28125), "488");
  EXPECT_EQ(grouped(1234567.0), "1,234,567");
  EXPECT_EQ(grouped(kUnset), "0");
}

}  // namespace
}  // namespace enc::netft
