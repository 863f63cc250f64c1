// Sockets, the tie between two clocks, and a fake's bad line.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/socket.h"
#include "tests/support/refusal.h"

namespace enc::net {
namespace {

constexpr Duration kSoon{2'000'000'000};  // limit for data that comes at once, on a busy machine too

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}
std::string received(Socket& socket, std::size_t most = 64) {
  std::array<std::byte, 64> bytes{};
  socket.wait(kSoon);
  const std::size_t size = socket.receive(std::span(bytes).first(most));
  return {reinterpret_cast<const char*>(bytes.data()), size};
}
Socket accepted(Socket& server) {
  server.wait(kSoon);
  return server.accept();
}
// Some containers lack IPv6.
bool has_ipv6() {
  try {
    return listen_tcp("::1", 0).is_open();
  } catch (const Error&) {
    return false;
  }
}

// A late reader gets the time of arrival, by datagrams and in a stream.
TEST(Socket, SaysWhenWhatItGaveHadCome) {
  Socket there = bind_udp("127.0.0.1", 0);
  Socket here = connect_udp("127.0.0.1", there.port());
  Socket server = listen_tcp("127.0.0.1", 0);
  Socket caller = connect_tcp("127.0.0.1", server.port(), kSoon);
  Socket called = accepted(server);
  for (const auto& [from, to] : {std::pair{&here, &there}, {&called, &caller}}) {
    const Duration sent = steady_now();
    from->send(bytes_of("x"));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(received(*to), "x");
    EXPECT_GE(to->came(), sent - Duration(1'000'000));
    EXPECT_LE(to->came(), steady_now() - Duration(40'000'000)) << "the kernel's word, not when it was read";
  }
}

TEST(Socket, CarriesBytesBothWays) {
  for (const char* address : {"127.0.0.1", "::1", "localhost"}) {
    if (address == std::string("::1") && !has_ipv6()) continue;
    Socket server = listen_tcp(address, 0);
    Socket client = connect_tcp(address, server.port(), kSoon);
    Socket other = accepted(server);
    ASSERT_TRUE(other.is_open()) << address;
    EXPECT_EQ(client.send(bytes_of("POS?\n")), 5U);
    EXPECT_EQ(received(other, 2), "PO") << "what does not fit is for the next time";
    EXPECT_EQ(received(other), "S?\n");
    EXPECT_EQ(other.send(bytes_of("X=1\n")), 4U);
    EXPECT_EQ(received(client), "X=1\n");
  }
}

TEST(Socket, DoesNotWait) {
  Socket server = listen_tcp("127.0.0.1", 0);
  EXPECT_FALSE(server.accept().is_open());
  Socket client = connect_tcp("127.0.0.1", server.port(), kSoon);
  std::array<std::byte, 8> bytes{};
  EXPECT_EQ(client.receive(bytes), 0U);
  EXPECT_FALSE(client.closed()) << "nothing came, and that is all";
  const Duration before = steady_now();
  EXPECT_FALSE(client.wait(Duration(2'000'000)));
  EXPECT_GE(steady_now() - before, Duration(2'000'000));
}

TEST(Socket, SaysThatTheOtherEndHasGone) {
  Socket server = listen_tcp("127.0.0.1", 0);
  Socket client = connect_tcp("127.0.0.1", server.port(), kSoon);
  { const Socket gone = accepted(server); }
  EXPECT_EQ(received(client), "");
  EXPECT_TRUE(client.closed());
  EXPECT_EQ(client.send(bytes_of("x")), 0U) << "and no signal ends the program";
}

// A client sends and its peer does not read: in the end the system accepts no more and reports it.
TEST(Socket, TakesNoMoreThanTheSystemDoes) {
  Socket server = listen_tcp("127.0.0.1", 0);
  Socket client = connect_tcp("127.0.0.1", server.port(), kSoon);
  const std::string much(1 << 20, 'x');
  std::size_t taken = much.size();
  for (int i = 0; i < 100 && taken == much.size(); ++i) taken = client.send(bytes_of(much));
  EXPECT_LT(taken, much.size());
  EXPECT_FALSE(client.closed());
}

TEST(Socket, Datagrams) {
  Socket server = bind_udp("127.0.0.1", 0);
  Socket client = connect_udp("127.0.0.1", server.port());
  EXPECT_EQ(server.reply(bytes_of("nobody")), 0U) << "nobody has asked yet";
  EXPECT_EQ(client.send(bytes_of("one")), 3U);
  EXPECT_EQ(client.send(bytes_of("two")), 3U);
  EXPECT_EQ(received(server, 2), "on") << "cut, and the rest is gone";
  EXPECT_EQ(received(server), "two");
  EXPECT_EQ(server.reply(bytes_of("nobody")), 0U) << "who sent is not answered before that is wanted";
  server.answer_sender();
  Socket stranger = connect_udp("127.0.0.1", server.port());
  EXPECT_EQ(stranger.send(bytes_of("?")), 1U);
  EXPECT_EQ(received(server), "?");
  EXPECT_EQ(server.reply(bytes_of("three")), 5U);
  EXPECT_EQ(received(client), "three");
  { const Socket gone = std::move(server); }
  client.send(bytes_of("four"));
  std::array<std::byte, 8> bytes{};
  client.wait(Duration(50'000'000));
  EXPECT_EQ(client.receive(bytes), 0U);
  EXPECT_FALSE(client.closed()) << "it may come back";
}

TEST(Socket, RefusesInClearWords) {
  using testing::HasSubstr;
  std::uint16_t port = 0;
  { port = listen_tcp("127.0.0.1", 0).port(); }
  EXPECT_THAT(test::refusal([&] { return connect_tcp("127.0.0.1", port, kSoon); }),
              testing::AllOf(HasSubstr(place("127.0.0.1", port)), HasSubstr("nobody listens there")));
  EXPECT_THAT(test::refusal([&] { return connect_tcp("no.such.host.invalid", port, kSoon); }),
              HasSubstr("'no.such.host.invalid' is no address and no name that is known"));
  const Socket taken = listen_tcp("127.0.0.1", 0);
  EXPECT_THAT(test::refusal([&] { return listen_tcp("127.0.0.1", taken.port()); }),
              HasSubstr("the port is taken"));
  for (const auto& listen : {listen_tcp, bind_udp})  // a documentation address that no machine has
    EXPECT_THAT(
        test::refusal([&] { return listen("192.0.2.1", 0); }),
        testing::AllOf(HasSubstr("192.0.2.1:0: "), HasSubstr("an address of this machine is needed")));
  EXPECT_EQ(place("::1", 80), "[::1]:80");
}

// A device's clock, tied to the loop's over a network with random delays.

// A device that stamps a message each 10 ms, and a network of 0.2 ms at least and 1 ms more on average.
struct Device {
  double ahead = 3.0, drift = 50e-6;  // its clock's lead at 0 s
  std::uint64_t seed = 1;
  ClockTie tie{from_seconds(kLeast)};
  std::mt19937_64 random{seed};
  double t = 0.0, late = 0.0;
  double worst = 0.0;     // greatest error of the reported age, s: since the last look
  double youngest = 0.0;  // s: most by which the reported age was too young

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

// All errors are within the stated bound, and nearly all within the stated spread.
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

// After a step forward the time is right except for the first message's delay, and soon as good as before.
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

// A step forward below the threshold is followed, too, also after a long time in which clocks may have
// drifted apart.
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

// The reader of the stamps calls forget() if a clock is set back.
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

// The tie cannot detect a clock that is set back during silence, or a lasting delay of all messages. It never
// takes old data for fresh.
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

// 50 ms more on the way, for any time: the clock stays the same, and drifts no faster than crystals do. The
// end of the delay is not a step forward.
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

// An error of the least delay is an error of the offset, and no spread shows it.
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

// The effect of a bad line on messages; a good line has no effect.

using Kind = Trouble::Kind;
using Wire = BadLine::Wire;

Time ms_at(int ms) { return Time(Duration(1'000'000) * ms); }

std::span<const std::byte> raw(const std::string& text) { return std::as_bytes(std::span(text)); }

// All messages that leave by then.
std::vector<std::string> left(BadLine& line, Time now) {
  std::vector<std::string> all;
  for (auto next = line.take(now); next; next = line.take(now)) {
    std::string text;
    for (const std::byte byte : *next) text.push_back(static_cast<char>(byte));
    all.push_back(text);
  }
  return all;
}

// A number each millisecond; return each number that came, with its time.
std::vector<std::pair<int, int>> sent(BadLine& line, int count) {
  std::vector<std::pair<int, int>> came;
  for (int ms = 0; ms < count + 100; ++ms) {
    if (ms < count) line.put(ms_at(ms), raw(std::to_string(ms)));
    for (const std::string& text : left(line, ms_at(ms))) came.emplace_back(std::stoi(text), ms);
  }
  return came;
}

TEST(BadLine, WithoutTroubleEachMessageLeavesAsItCame) {
  for (const Wire wire : {Wire::datagrams, Wire::stream}) {
    BadLine line(wire, 1);
    const auto came = sent(line, 1000);
    ASSERT_EQ(came.size(), 1000U);
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(came[static_cast<std::size_t>(i)], std::pair(i, i));
  }
}

TEST(BadLine, LossAndDuplicatesAreSoManyOfThem) {
  constexpr int kSent = 20'000;
  const double sigma = std::sqrt(0.2 * 0.8 / kSent);
  BadLine lossy(Wire::datagrams, 2);
  lossy.suffer({Kind::loss, 0.2});
  EXPECT_NEAR(static_cast<double>(sent(lossy, kSent).size()) / kSent, 0.8, 5.0 * sigma);
  BadLine twice(Wire::datagrams, 3);
  twice.suffer({Kind::duplicate, 0.2});
  EXPECT_NEAR(static_cast<double>(sent(twice, kSent).size()) / kSent, 1.2, 5.0 * sigma);
}

TEST(BadLine, WhatIsReorderedComesBehindTheNext) {
  BadLine line(Wire::datagrams, 4);
  line.suffer({Kind::reorder, 0.3});
  const auto came = sent(line, 10'000);
  EXPECT_GE(came.size(), 9'990U);  // the last may still wait
  int swapped = 0;
  for (std::size_t i = 1; i < came.size(); ++i) swapped += came[i].first < came[i - 1].first ? 1 : 0;
  EXPECT_NEAR(swapped / 10'000.0, 0.3, 0.1) << "two that are held one after another are one swap";
  std::set<int> all;
  for (const auto& [number, at] : came) {
    EXPECT_LE(at - number, 20);
    EXPECT_TRUE(all.insert(number).second);
  }
}

TEST(BadLine, JitterIsUpToSoLongAndAStreamKeepsItsOrder) {
  for (const Wire wire : {Wire::datagrams, Wire::stream}) {
    BadLine line(wire, 5);
    line.suffer({Kind::jitter, 0.020});
    const auto came = sent(line, 5'000);
    ASSERT_EQ(came.size(), 5'000U);
    int backward = 0, latest = 0;
    for (std::size_t i = 0; i < came.size(); ++i) {
      latest = std::max(latest, came[i].second - came[i].first);
      backward += i > 0 && came[i].first < came[i - 1].first ? 1 : 0;
    }
    EXPECT_GE(latest, 18);
    EXPECT_LE(latest, 21);
    EXPECT_EQ(backward > 0, wire == Wire::datagrams);
  }
}

TEST(BadLine, GarbageAndHalfMessages) {
  BadLine line(Wire::stream, 6);
  line.suffer({Kind::garbage, 1.0});
  const std::string text = "X=1.5 \nY=2\n";
  line.put(ms_at(0), raw(text));
  std::vector<std::string> came = left(line, ms_at(0));
  ASSERT_EQ(came.size(), 1U);
  EXPECT_EQ(came[0].size(), text.size());
  EXPECT_NE(came[0], text);
  EXPECT_EQ(came[0].back(), '\n');
  line.heal(Kind::garbage);
  line.suffer({Kind::half_message, 1.0});
  line.put(ms_at(1), raw("123456"));
  EXPECT_EQ(left(line, ms_at(1)), std::vector<std::string>{"123"});
  line.heal(Kind::half_message);
  line.put(ms_at(2), raw("123456"));
  EXPECT_EQ(left(line, ms_at(2)), std::vector<std::string>{"123456"});
}

TEST(BadLine, WhereAllComeBehindTheNextEachStillComes) {
  BadLine line(Wire::datagrams, 7);
  line.suffer({Kind::reorder, 1.0});
  std::vector<std::string> came;
  for (int i = 0; i < 10; ++i) {
    line.put(ms_at(i), raw(std::to_string(i)));
    for (std::string& one : left(line, ms_at(i))) came.push_back(std::move(one));
  }
  EXPECT_EQ(came, (std::vector<std::string>{"1", "0", "3", "2", "5", "4", "7", "6", "9", "8"}));
}

TEST(BadLine, ASlowStartKeepsAStreamAndDropsDatagrams) {
  for (const Wire wire : {Wire::datagrams, Wire::stream}) {
    BadLine line(wire, 7);
    line.suffer({Kind::slow_start, 0.050});
    line.begin(ms_at(100));
    line.put(ms_at(110), raw("a"));
    line.put(ms_at(120), raw("b"));
    EXPECT_TRUE(left(line, ms_at(149)).empty());
    EXPECT_EQ(left(line, ms_at(150)).size(), wire == Wire::stream ? 2U : 0U);
    line.put(ms_at(151), raw("c"));
    EXPECT_EQ(left(line, ms_at(151)), std::vector<std::string>{"c"});
  }
}

TEST(BadLine, GoesOnWhereTimeBeginsAnew) {
  BadLine line(Wire::stream, 10);
  line.put(ms_at(3000), raw("a"));
  EXPECT_EQ(left(line, ms_at(3000)).size(), 1U);
  line.put(ms_at(1), raw("b"));
  EXPECT_EQ(left(line, ms_at(1)), std::vector<std::string>{"b"});
}

TEST(BadLine, ADeadOneSaysNothingUntilItIsHealed) {
  for (const Kind kind : {Kind::stall, Kind::disconnect}) {
    BadLine line(Wire::datagrams, 8);
    line.suffer({kind, 0.0});
    EXPECT_TRUE(line.dead());
    line.put(ms_at(0), raw("a"));
    EXPECT_TRUE(left(line, ms_at(1)).empty());
    line.heal(kind);
    line.put(ms_at(2), raw("b"));
    EXPECT_EQ(left(line, ms_at(2)), std::vector<std::string>{"b"});
  }
}

TEST(BadLine, AStreamNeitherLosesNorSwaps) {
  const BadLine stream(Wire::stream, 9), datagrams(Wire::datagrams, 9);
  for (const Kind kind : {Kind::loss, Kind::reorder, Kind::duplicate}) {
    EXPECT_FALSE(stream.knows(kind));
    EXPECT_TRUE(datagrams.knows(kind));
  }
  for (const Kind kind : {Kind::saturate, Kind::error_code}) EXPECT_FALSE(datagrams.knows(kind));
  for (const Kind kind :
       {Kind::jitter, Kind::stall, Kind::disconnect, Kind::garbage, Kind::half_message, Kind::slow_start})
    EXPECT_TRUE(stream.knows(kind));
}

}  // namespace
}  // namespace enc::net
