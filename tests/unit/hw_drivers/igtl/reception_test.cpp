// Datagrams that are lost, late, doubled or from another clock.
#include "hw_drivers/igtl/drive/reception.h"

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hw_drivers/net/big_endian.h"

namespace enc::igtl {
namespace {

constexpr Duration ms(double n) { return from_seconds(1e-3 * n); }
const std::vector<std::string> kTools{"stylus", "a_tool_with_a_long_name"};

OutgoingMessage pose(double x, std::int64_t stamp_ns, std::uint32_t number,
                     const char* device = "stylusToTracker") {
  return {"TRANSFORM", device, stamp_ns, number, transform(Pose<'C', 'T'>::shift(x, 0, 1))};
}

struct Bench {
  IgtlSettings settings;
  Reception reception;
  Measurement<TrackedTool> newest;
  explicit Bench(bool lockstep = true, double least_delay = 0.0)
      : reception(with(least_delay), kTools, lockstep) {}
  explicit Bench(const std::string& transport) : reception(with(0.0, transport), kTools, false) {}
  IgtlSettings with(double least_delay, const std::string& transport = "udp") {
    settings.least_delay = least_delay;
    settings.transport = transport;
    return settings;
  }
  bool take(const OutgoingMessage& message, double now_ms = 0.0) {
    return reception.take(message.bytes(), Time(ms(now_ms)), newest);
  }
};

TEST(IgtlReception, TakesEachPoseOnceWithItsToolAndTime) {
  Bench bench;
  EXPECT_TRUE(bench.take(pose(0.25, 5'000'000, 1)));
  EXPECT_EQ(bench.newest.health, Health::ok);
  EXPECT_EQ(bench.newest.value.tool, 0);
  EXPECT_EQ(bench.newest.t, Time(ms(5)));
  EXPECT_EQ(bench.newest.value.X_CT.p().x(), 0.25);
  EXPECT_FALSE(bench.take(pose(0.5, 6'000'000, 1))) << "a number twice";
  EXPECT_FALSE(bench.take(pose(0.5, 5'000'000, 2))) << "a stamp twice";
  EXPECT_TRUE(bench.take(pose(0.5, 700'000'000, 3, "a_tool_with_a_long_nameToTracker")))
      << "cut to 20 letters";
  EXPECT_EQ(bench.newest.value.tool, 1);
  EXPECT_FALSE(bench.take(pose(0.5, 800'000'000, 4, "hammerToTracker")));
  EXPECT_EQ(bench.reception.counts().poses, 2);
  EXPECT_EQ(bench.reception.counts().old, 2);
  EXPECT_EQ(bench.reception.counts().unknown, 1);
  EXPECT_EQ(bench.reception.counts().stranger.view(), "hammerToTracker");
}

TEST(IgtlReception, NumbersGoRound) {
  Bench bench;
  EXPECT_TRUE(bench.take(pose(0, 1, 0xfffffffe)));
  EXPECT_TRUE(bench.take(pose(0, 2, 0xffffffff)));
  EXPECT_TRUE(bench.take(pose(0, 3, 0)));
  EXPECT_FALSE(bench.take(pose(0, 4, 0xffffffff)));
  EXPECT_TRUE(bench.take(pose(0, 5, 3)));
  EXPECT_EQ(bench.reception.counts().missing, 2);
}

// Any loss, reordering and doubling: stamps only grow, the newest stays, doubles change nothing.
TEST(IgtlReception, AnyWayOfDatagramsGivesTimesThatOnlyGrow) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    Bench once, doubled;
    std::vector<int> way;
    for (int i = 1; i <= 500; ++i)
      if (random() % 5 != 0) way.push_back(i);  // a fifth is lost
    for (std::size_t i = 0; i + 3 < way.size(); ++i)
      if (random() % 10 < 3) std::swap(way[i], way[i + 1 + random() % 2]);
    Time last{};
    int most = 0;
    for (const int n : way) {
      const OutgoingMessage message = pose(1e-3 * n, 10'000'000LL * n, static_cast<std::uint32_t>(n));
      const bool news = once.take(message);
      EXPECT_EQ(news, n > most) << "seed " << seed;
      most = std::max(most, n);
      EXPECT_GE(once.newest.t, last);
      last = once.newest.t;
      EXPECT_EQ(doubled.take(message), news);
      EXPECT_FALSE(doubled.take(message));
      EXPECT_EQ(doubled.newest.t, once.newest.t);
      EXPECT_EQ(doubled.newest.value.X_CT.xyz, once.newest.value.X_CT.xyz);
    }
    EXPECT_EQ(most, *std::max_element(way.begin(), way.end()));
  }
}

// If a frame shows two tools, the one in the hand counts.
TEST(IgtlReception, OfTwoToolsInViewTheOneInTheHandCounts) {
  Bench bench(false);
  for (std::uint32_t n = 1; n <= 50; ++n) {
    const std::int64_t stamp = 10'000'000LL * n;
    EXPECT_TRUE(bench.take(pose(1e-3 * n, stamp, 2 * n), 10.0 * n));
    EXPECT_FALSE(bench.take(pose(0.3, stamp, 2 * n + 1, "a_tool_with_a_long_nameToTracker"), 10.0 * n));
    EXPECT_EQ(bench.newest.value.tool, 0);
  }
  EXPECT_EQ(bench.reception.counts().aside, 50);
}

// A clock that is set back counts as a new clock.
TEST(IgtlReception, AClockThatIsSetBackIsNew) {
  Bench bench(false);
  EXPECT_TRUE(bench.take(pose(0.1, 1'000'000'000, 1), 100.0));
  EXPECT_TRUE(bench.take(pose(0.3, 500'000'000, 3), 110.0)) << "half a second earlier";
  EXPECT_EQ(bench.newest.t, Time(ms(110)));
  EXPECT_EQ(bench.reception.counts().steps, 1);
  EXPECT_FALSE(bench.take(pose(0.3, 1'010'000'000, 2), 111.0)) << "an older number";
  EXPECT_TRUE(bench.take(pose(0.4, 510'000'000, 4), 120.0));
  EXPECT_EQ(bench.newest.t, Time(ms(120)));
}

// Two sources may also differ by less than that, but such messages never go back twice in a row.
TEST(IgtlReception, AClockThatIsSetBackByLittleIsNewFromItsSecondMessageOn) {
  for (const char* transport : {"udp", "tcp"}) {
    Bench bench{std::string(transport)};
    std::uint32_t number = 0;
    const auto take = [&](std::int64_t stamp_ms, double now_ms) {
      return bench.take(pose(1e-3 * now_ms, stamp_ms * 1'000'000, ++number), now_ms);
    };
    for (int n = 0; n < 100; ++n) EXPECT_TRUE(take(1000 + 10 * n, 10.0 * n + (n % 3)));
    EXPECT_FALSE(take(1960, 1000.0)) << "40 ms earlier than it would be";
    EXPECT_TRUE(take(1970, 1010.0));
    EXPECT_EQ(bench.newest.t, Time(ms(1010)));
    EXPECT_TRUE(take(1980, 1020.0));
    EXPECT_EQ(bench.newest.t, Time(ms(1020)));
    EXPECT_EQ(bench.reception.counts().steps, 1);
    Bench two{std::string(transport)};
    for (int n = 0; n < 100; ++n) {
      EXPECT_TRUE(two.take(pose(0.1, (1000 + 10 * n) * 1'000'000LL, ++number), 10.0 * n));
      EXPECT_EQ(two.take(pose(0.1, (995 + 10 * n) * 1'000'000LL, ++number), 10.0 * n + 1.0), false);
    }
    EXPECT_EQ(two.reception.counts().steps, 0);
  }
}

// Without numbers, a stamp that is earlier by more than any datagram's delay comes from a clock that was set
// back.
TEST(IgtlReception, WithoutNumbersAClockThatIsSetBackByMoreThanASecondIsNew) {
  Bench bench(false);
  const auto plain = [](std::int64_t stamp_ns) {
    return OutgoingMessage("TRANSFORM", "stylusToTracker", stamp_ns,
                           transform(Pose<'C', 'T'>::shift(0.1, 0, 1)));
  };
  EXPECT_TRUE(bench.take(plain(100'000'000'000), 100.0));
  EXPECT_FALSE(bench.take(plain(99'500'000'000), 101.0)) << "half a second: overtaken";
  EXPECT_TRUE(bench.take(plain(90'000'000'000), 110.0));
  EXPECT_EQ(bench.newest.t, Time(ms(110)));
  EXPECT_EQ(bench.reception.counts().steps, 1);
}

// PLUS begins the names of its transforms with a capital letter.
TEST(IgtlReception, TheFirstLetterOfADeviceMayBeLarge) {
  Bench bench(std::string("tcp"));
  EXPECT_TRUE(bench.take(pose(0.25, 10'000'000, 1, "StylusToTracker")));
  EXPECT_FALSE(bench.take(pose(0.25, 20'000'000, 2, "stYlusToTracker")));
  EXPECT_EQ(bench.reception.counts().unknown, 1);
}

// A stream keeps the order: its messages need no number, and an earlier stamp is another clock.
TEST(IgtlReception, OfAStreamTheOrderIsThatOfItsMessages) {
  Bench bench(std::string("tcp"));
  const auto plain = [](double x, std::int64_t stamp_ns) {
    return OutgoingMessage("TRANSFORM", "stylusToTracker", stamp_ns,
                           transform(Pose<'C', 'T'>::shift(x, 0, 1)));
  };
  EXPECT_TRUE(bench.take(plain(0.1, 1'000'000'000), 100.0));
  EXPECT_FALSE(bench.take(plain(0.1, 1'000'000'000), 101.0)) << "the same pose again";
  EXPECT_TRUE(bench.take(plain(0.2, 1'010'000'000), 110.0));
  EXPECT_TRUE(bench.take(plain(0.3, 500'000'000), 120.0));
  EXPECT_EQ(bench.newest.t, Time(ms(120)));
  EXPECT_EQ(bench.reception.counts().steps, 1);
  EXPECT_TRUE(bench.take(pose(0.4, 510'000'000, 5), 130.0));
  EXPECT_TRUE(bench.take(pose(0.5, 520'000'000, 5), 140.0)) << "a server may give each the same number";
  EXPECT_EQ(bench.reception.counts().old, 1);
}

// One pose in each of its forms; a TDATA of several tools, of which the scene names one.
TEST(IgtlReception, TakesPosesInEachForm) {
  Bench bench(std::string("tcp"));
  const Pose<'C', 'T'> X_CT = Pose<'C', 'T'>::shift(0.25, 0.5, 1);
  std::vector<std::byte> all;
  for (const char* name : {"hammerToTracker", "stylus"}) {  // also by the tool's name alone
    const auto one = element(name, X_CT);
    all.insert(all.end(), one.begin(), one.end());
  }
  EXPECT_TRUE(bench.take({"TDATA", "Tracker", 10'000'000, all}));
  EXPECT_EQ(bench.newest.value.tool, 0);
  EXPECT_LT((bench.newest.value.X_CT.p() - X_CT.p()).norm(), 1e-15);
  EXPECT_EQ(bench.reception.counts().unknown, 1);
  EXPECT_EQ(bench.reception.counts().stranger.view(), "hammerToTracker");
  std::array<std::byte, 28> position{};
  const std::array<float, 7> numbers{250, 500, 1000, 0, 0, 0, 1};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    net::put(std::span<std::byte>(position), 4 * i, std::bit_cast<std::uint32_t>(numbers[i]));
  EXPECT_TRUE(bench.take({"POSITION", "stylusToTracker", 20'000'000, position}));
  EXPECT_LT((bench.newest.value.X_CT.p() - X_CT.p()).norm(), 1e-15);
  EXPECT_FALSE(bench.take({"TDATA", "Tracker", 30'000'000, std::span(all).first(71)}));
  EXPECT_FALSE(bench.take({"POSITION", "stylusToTracker", 30'000'000, std::span(position).first(12)}));
  EXPECT_EQ(bench.reception.counts().wrong, 2);
  EXPECT_FALSE(bench.take({"TRANSFORM", "stylusToTracker", 30'000'000, 1, transform(X_CT), "TransformStatus",
                           "TOOL_OUT_OF_VIEW"}));
  EXPECT_EQ(bench.reception.counts().unseen, 1);
}

TEST(IgtlReception, WhatTheServerReportsIsKept) {
  Bench bench;
  EXPECT_FALSE(bench.take({"STATUS", "Server", 0, 1, status(1)}));
  EXPECT_EQ(bench.reception.counts().status, 0);
  EXPECT_FALSE(bench.take({"STATUS", "Server", 0, 2, status(17)}));
  EXPECT_EQ(bench.reception.counts().status, 17);
}

// A server without stamps, or with whole seconds only: the first message counts, the next is a double, and
// from then on the stamp stands still.
TEST(IgtlReception, AStampThatStandsStillIsCountedApart) {
  Bench bench(std::string("tcp"));
  for (std::int64_t second = 0; second < 3; ++second)
    for (int n = 0; n < 10; ++n)
      EXPECT_EQ(bench.take(pose(0.01 * n, second * 1'000'000'000, 1), 1e3 * second + 100.0 * n), n == 0);
  EXPECT_EQ(bench.reception.counts().poses, 3);
  EXPECT_EQ(bench.reception.counts().old, 3);
  EXPECT_EQ(bench.reception.counts().standing, 24);
}

TEST(IgtlReception, PosesThatRepeatTheOneBeforeAreCounted) {
  Bench bench(std::string("tcp"));
  for (std::int64_t n = 1; n <= 10; ++n)
    EXPECT_TRUE(bench.take(pose(n <= 4 ? 0.1 : 0.1 + 1e-6 * static_cast<double>(n), 10'000'000 * n, 1)));
  EXPECT_EQ(bench.reception.counts().repeated, 3);
  EXPECT_EQ(bench.reception.counts().poses, 10);
}

TEST(IgtlReception, AWrongChecksumIsCountedApartFromWhatIsNoMessage) {
  Bench bench(std::string("tcp"));
  const OutgoingMessage good = pose(0.1, 10'000'000, 1);
  std::vector<std::byte> bytes(good.bytes().begin(), good.bytes().end());
  net::put(std::span(bytes), 50, std::uint64_t{0});
  EXPECT_FALSE(bench.reception.take(bytes, Time{}, bench.newest));
  net::put(std::span(bytes), 50, std::uint64_t{77});
  EXPECT_FALSE(bench.reception.take(bytes, Time{}, bench.newest));
  EXPECT_FALSE(bench.reception.take(std::span(bytes).first(20), Time{}, bench.newest));
  EXPECT_EQ(bench.reception.counts().checksum, 2);
  EXPECT_EQ(bench.reception.counts().no_checksum, 1);
  EXPECT_EQ(bench.reception.counts().wrong, 1);
}

// The quickest was 12.7 ms under way, and the tie subtracts that. A much later message is late, and stays
// late however long the delay lasts.
TEST(IgtlReception, TheLeastDelayIsTakenOffAndADelayThatLastsIsNoClock) {
  Bench bench(false, 12.7e-3);
  for (std::uint32_t n = 1; n <= 100; ++n)
    ASSERT_TRUE(bench.take(pose(0, 10'000'000LL * n, n), 10.0 * n + 12.7));
  EXPECT_NEAR(seconds(bench.newest.t.time_since_epoch()), 1.0, 1e-6);
  for (std::uint32_t n = 101; n <= 2000; ++n)
    ASSERT_TRUE(bench.take(pose(0, 10'000'000LL * n, n), 10.0 * n + 12.7 + 50.0));
  EXPECT_LT(seconds(bench.newest.t.time_since_epoch()), 20.0 + 0.005) << "50 ms late: 19 s later, too";
  EXPECT_GE(seconds(bench.newest.t.time_since_epoch()), 20.0 - 1e-6);
}

// A clock with another start that is 50 ppm too fast, and a network of 0.2 ms at least and 2 ms on average.
TEST(IgtlReception, AnotherClockIsTiedToThisOne) {
  std::mt19937_64 random(7);
  std::exponential_distribution<double> more(1.0 / 2e-3);
  Bench bench(false, 0.2e-3);
  double worst = 0.0;
  for (std::uint32_t n = 1; n <= 6000; ++n) {
    const double t = 0.01 * n;
    const auto stamp = static_cast<std::int64_t>(1e9 * (1700.0 + t * (1.0 + 50e-6)));
    const double arrives = t + 0.2e-3 + more(random);
    if (!bench.take(pose(0, stamp, n), 1e3 * arrives)) continue;
    if (t > 5.0) worst = std::max(worst, std::abs(seconds(bench.newest.t.time_since_epoch()) - t));
  }
  EXPECT_LT(worst, 0.5e-3);
  EXPECT_GT(bench.reception.counts().poses, 5000);
}

}  // namespace
}  // namespace enc::igtl
