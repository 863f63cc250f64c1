// The driver of hands in lines of text and its fake over loopback; each against hand-tracking-sdk, too. The
// simulated hand tracker.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/hand/drive/line_tracker.h"
#include "hw_drivers/hand/fake/server.h"
#include "hw_drivers/hand/wire/coordinates.h"
#include "hw_drivers/hand/wire/line.h"
#include "tests/support/built.h"
#include "tests/support/devices.h"
#include "tests/support/error_of.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"
#include "tests/support/twin.h"

namespace enc::test {
namespace {

using testing::HasSubstr;

// A hand that a test knows: a quarter turn about z, and each joint at another place.
HandSample known_hand() {
  HandSample hand;
  hand.side = HandSide::left;
  hand.wrist = {Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ())), Vec3(0.1, -0.2, 0.3)};
  for (std::size_t i = 0; i < kHandJoints; ++i) {
    const double n = static_cast<double>(i);
    hand.joints[i] = hand.wrist * Point<'K'>(0.01 * n, 0.001 * n, -0.002 * n);
  }
  hand.skin = 0.008;
  return hand;
}

// Gives that hand 120 times a second.
struct KnownHand final : HandTracker {
  bool poll(Time now, Measurement<HandSample>& newest) noexcept override {
    constexpr Duration kFrame{8'333'333};
    if (hidden || now - last < kFrame) return false;
    last = now;
    newest = {known_hand(), now, Health::ok};
    return true;
  }
  Time last{};
  std::atomic<bool> hidden = false;
};

void expect_same(const HandSample& hand, const HandSample& other) {
  EXPECT_EQ(hand.side, other.side);
  EXPECT_LT((hand.wrist.p() - other.wrist.p()).norm(), 1e-12);
  EXPECT_LT(hand.wrist.q().angularDistance(other.wrist.q()), 1e-7);
  for (std::size_t i = 0; i < kHandJoints; ++i)
    EXPECT_LT((hand.joints[i] - other.joints[i]).norm(), 1e-12) << i;
}

// ---- lines

TEST(HandLine, IsReadAndWrittenToTheLastBit) {
  hand::Packet packet;
  ASSERT_EQ(hand::read("Right wrist | f=12 | t=1500000000: 0.1, -2e-3,3 ,+4,5,6.5,7\r", packet),
            hand::LineFault::nothing);
  EXPECT_EQ(packet.side, hand::Side::right);
  EXPECT_EQ(packet.frame, 12);
  EXPECT_EQ(packet.stamp_ns, 1'500'000'000);
  EXPECT_EQ(packet.values[1], -2e-3);
  packet.values[0] = 1.0 / 3.0;
  hand::Packet again;
  ASSERT_EQ(hand::read(hand::line_of(packet), again), hand::LineFault::nothing);
  EXPECT_EQ(again.values, packet.values);
  EXPECT_EQ(hand::line_of(again), hand::line_of(packet));
}

TEST(HandLine, WhatIsWrongIsSaid) {
  using hand::LineFault;
  const std::pair<const char*, LineFault> lines[] = {
      {"", LineFault::empty},
      {"  \t", LineFault::empty},
      {"Right wrist 1,2,3", LineFault::colon},
      {"right wrist: 1,2,3,4,5,6,7", LineFault::label},
      {"Right wrist too: 1,2,3,4,5,6,7", LineFault::label},
      {"Right wrist | f=x: 1,2,3,4,5,6,7", LineFault::metadata},
      {"Right wrist: 1,2,3,4,5,6,x", LineFault::number},
      {"Right wrist: 1,2,3,4,5,6,nan", LineFault::number},
      {"Right wrist: 1,2,3,4,5,6,1e999", LineFault::number},
      {"Right wrist: 1,2,3,4,5,6", LineFault::count},
      {"Right wrist: 1,2,3,4,5,6,7,8", LineFault::count},
      {"Right landmarks: 1,2,3,4,5,6,7", LineFault::count}};
  hand::Packet packet;
  for (const auto& [line, wrong] : lines) EXPECT_EQ(hand::read(line, packet), wrong) << line;
}

TEST(HandLine, ALineThatIsTooLongIsSkipped) {
  hand::Lines lines;
  const std::string text = std::string(10'000, 'x') + "\nRight wrist: 1\n";
  std::string seen;
  for (std::size_t at = 0; at < text.size();) {
    const auto room = lines.room();
    const std::size_t part = std::min({room.size(), text.size() - at, std::size_t{700}});
    std::memcpy(room.data(), text.data() + at, part);
    lines.came(part);
    at += part;
    for (auto line = lines.next(); line; line = lines.next()) seen += std::string(*line) + ";";
  }
  EXPECT_EQ(seen, "Right wrist: 1;");
  EXPECT_EQ(lines.skipped(), 1);
}

// A right-handed turn by a quarter about x is a left-handed one the other way.
TEST(HandCoordinates, AreMirrored) {
  EXPECT_EQ(hand::from_wire(1, 2, 3), Vec3(1, -2, 3));
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
    const Pose<'L', 'K'> pose(Quat(Eigen::AngleAxisd(0.5, axis)), Vec3(1, 2, 3));
    const auto wire = hand::pose_to_wire(pose);
    const Pose<'L', 'K'> back = hand::pose_from_wire(wire);
    EXPECT_LT((back.p() - pose.p()).norm(), 1e-15);
    EXPECT_LT(back.q().angularDistance(pose.q()), 1e-7);
    // On the wire the quaternion turns mirrored points.
    const Quat turned(wire[6], wire[3], wire[4], wire[5]);
    const Vec3 at(0.1, 0.2, 0.3);
    const auto mirrored = [](const Vec3& v) { return Vec3(v.x(), -v.y(), v.z()); };
    EXPECT_LT((turned * mirrored(at) - mirrored(pose.q() * at)).norm(), 1e-15);
  }
  std::array<double, 7> wire{0, 0, 0, 0, 0, 0, 1.2};
  EXPECT_FALSE(hand::pose_from_wire(wire).valid());
}

// ---- reception

struct HandStream {
  // The lines of frame n, stamped with it, that came at this time.
  bool take(std::int64_t n, double stamp, double came) {
    const std::string lines = hand::lines_of({known_hand(), Time(from_seconds(stamp)), Health::ok}, n, true);
    const std::size_t half = lines.find('\n');
    const Time at(from_seconds(came));
    return reception.take(lines.substr(0, half), at, newest) ||
           reception.take(lines.substr(half + 1), at, newest);
  }
  static hand::HandSettings left() {
    hand::HandSettings settings;
    settings.side = "left";
    return settings;
  }
  hand::Reception reception{left()};
  Measurement<HandSample> newest;
};

TEST(HandReception, JoinsAWristWithItsLandmarks) {
  HandStream stream;
  const std::string lines = hand::lines_of({known_hand(), Time(from_seconds(5.0)), Health::ok}, 7, true);
  const std::string wrist = lines.substr(0, lines.find('\n')), landmarks = lines.substr(lines.find('\n') + 1);
  const Time came(from_seconds(1.0));
  EXPECT_FALSE(stream.reception.take(landmarks, came, stream.newest));
  EXPECT_TRUE(stream.reception.take(wrist, came, stream.newest)) << "in either order";
  expect_same(stream.newest.value, known_hand());
  EXPECT_TRUE(stream.reception.fake());
  EXPECT_FALSE(stream.reception.take(wrist, came, stream.newest));
  EXPECT_EQ(stream.reception.counts().old, 1);
  EXPECT_FALSE(stream.reception.take("Left wrist | f=8: 0,0,0,0,0,0,1", came, stream.newest));
  EXPECT_FALSE(stream.reception.take("Left wrist | f=9: 0,0,0,0,0,0,1", came, stream.newest));
  EXPECT_EQ(stream.reception.counts().alone, 1);
  EXPECT_FALSE(stream.reception.take("Right wrist | f=9: 0,0,0,0,0,0,1", came, stream.newest));
  EXPECT_FALSE(stream.reception.take("Head pose: 0,0,0,0,0,0,1", came, stream.newest));
  EXPECT_EQ(stream.reception.counts().other, 2);
  EXPECT_TRUE(stream.take(12, 5.1, 1.1));
  EXPECT_EQ(stream.reception.counts().missing, 4);
  EXPECT_TRUE(stream.take(1'000'000, 5.2, 1.2) && stream.take(13, 5.3, 1.3)) << "a headset that began anew";
}

// Its app was started again after a few seconds: its frames begin at 0, and no old line is that late.
TEST(HandReception, AHeadsetThatBeginsAnewAfterAFewFramesIsHeard) {
  HandStream stream;
  EXPECT_TRUE(stream.take(500, 5.0, 1.0));
  EXPECT_FALSE(stream.take(499, 4.99, 1.1)) << "late";
  EXPECT_FALSE(stream.take(0, 0.0, 1.4));
  EXPECT_TRUE(stream.take(7, 0.2, 1.6)) << "silent for more than silent_ms";
  EXPECT_TRUE(stream.take(8, 0.3, 1.7));
  EXPECT_FALSE(stream.take(8, 0.3, 1.7));
  EXPECT_EQ(stream.reception.counts().missing, 0);
}

// The headset's clock is 100 s ahead and gains 80 ppm; lines come 30 to 45 ms after the exposure.
TEST(HandReception, FindsOffsetAndDriftOfTheClock) {
  HandStream stream;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> late(0.0, 0.015);
  double worst = 0.0;
  for (int i = 0; i < 120 * 40; ++i) {
    const double exposed = i / 120.0, stamp = 100.0 + exposed * (1 + 80e-6);
    ASSERT_TRUE(stream.take(i, stamp, exposed + 0.03 + late(random)));
    if (exposed > 30.0)
      worst = std::max(worst, std::abs(seconds(stream.newest.t.time_since_epoch()) - exposed));
  }
  EXPECT_LT(worst, 0.6e-3);
  const net::ClockEstimate clock = stream.reception.clock();
  EXPECT_NEAR(clock.drift, 80e-6, 10e-6);
  EXPECT_NEAR(clock.ahead, 100.0 + 40 * 80e-6, 1e-3);
}

// ---- the driver and its fake

struct HandPort {
  struct Table final : DefaultOffer::Defaults {
    using DefaultOffer::Defaults::value;
    void value(const Setting& key, double& number) override {
      if (key.name == "silent_ms") number = 0.1;
      if (key.name == "timeout_ms") number = 0.3;
    }
    void value(const Setting& key, std::int64_t& whole) override {
      if (key.name == "port") whole = port;
    }
    void value(const Setting& key, std::string& text) override {
      if (key.name == "address") text = "127.0.0.1";
      if (key.name == "side") text = side;
      if (key.name == "transport") text = transport;
    }
    std::int64_t port = 0;
    std::string side = "left", transport = "udp";
  };
  explicit HandPort(const std::string& transport) {
    hand::HandSettings settings;
    settings.address = "127.0.0.1";
    settings.transport = transport;
    if (!settings.streams()) settings.port = net::bind_udp("127.0.0.1", 0).port();
    if (settings.streams()) settings.port = 0;
    server = std::make_unique<hand::Server>(hand, settings);
    table.transport = transport;
    table.port = settings.streams() ? server->port() : settings.port;
  }
  std::unique_ptr<HandTracker> driver() { return hand::listening(offer()); }
  Offer offer() { return {table, defaults.rig, defaults.reach, Duration(1'000'000), defaults.log}; }
  std::string refused() {
    return error_of([&] { static_cast<void>(driver()); }, ErrorKind::device);
  }
  DefaultOffer defaults;
  Table table;
  KnownHand hand;
  std::unique_ptr<hand::Server> server;
};

class HandDriver : public testing::TestWithParam<std::string> {
 protected:
  // Polls for this time; the number of new hands.
  int poll(HandTracker& driver, int ms) {
    int news = 0;
    for (int i = 0; i < ms; ++i) {
      const Time now(net::steady_now() - begun);
      if (driver.poll(now, newest)) {
        ++news;
        EXPECT_LE(newest.t, now);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return news;
  }
  Duration begun = net::steady_now();
  Measurement<HandSample> newest;
  HandPort there{GetParam()};
};

TEST_P(HandDriver, GivesTheHandThatTheFakeSends) {
  const FakeServer served(*there.server);
  const auto driver = there.driver();
  EXPECT_TRUE(driver->is_fake());
  EXPECT_THAT(driver->describe(), testing::AllOf(HasSubstr("left hand"), HasSubstr(", answered")));
  EXPECT_GT(poll(*driver, 300), 15);
  EXPECT_EQ(newest.health, Health::ok);
  expect_same(newest.value, known_hand());
  EXPECT_EQ(newest.value.skin, 0.008);
  EXPECT_TRUE(driver->linked());
  EXPECT_THAT(driver->remarks().at(0), HasSubstr("0 old or twice, 0 wrong; its clock is "));
}

TEST_P(HandDriver, ALinkWithoutHandsIsLostAndComesBackWithThem) {
  const FakeServer served(*there.server);
  const auto driver = there.driver();
  poll(*driver, 100);
  there.hand.hidden = true;
  poll(*driver, 250);
  EXPECT_FALSE(driver->linked());
  there.hand.hidden = false;
  EXPECT_GT(poll(*driver, 100), 3);
  EXPECT_TRUE(driver->linked());
  EXPECT_THAT(driver->remarks().at(0), HasSubstr("; silent 1 times"));
}

TEST_P(HandDriver, FaultsOfTheWireGiveNoFalseHand) {
  for (const Trouble& trouble :
       {Trouble{Trouble::Kind::garbage, 0.5}, Trouble{Trouble::Kind::half_message, 0.5},
        Trouble{Trouble::Kind::jitter, 0.02}}) {
    const HandPort own(GetParam());
    HandPort& port = const_cast<HandPort&>(own);
    port.server->suffer(trouble);
    const FakeServer served(*port.server);
    const auto driver = port.driver();
    EXPECT_GT(poll(*driver, 300), 2);
    expect_same(newest.value, known_hand());
  }
}

// A datagram that does not fit: its last number would be another one.
TEST(HandDatagram, ThatIsCutIsNotBelieved) {
  HandPort there("udp");
  std::string wrist = "Left wrist: 0,0,0,0,0,0,1", landmarks = "Left landmarks: ";
  for (int i = 0; i < 62; ++i) landmarks += "0.1,";
  landmarks += "0.";
  landmarks.append(hand::kLongestLine, '1');
  landmarks += "e9";
  net::Socket headset = net::connect_udp("127.0.0.1", static_cast<std::uint16_t>(there.table.port));
  std::atomic<bool> end = false;
  std::thread sending([&] {
    while (!end) {
      headset.send(std::as_bytes(std::span(wrist)));
      headset.send(std::as_bytes(std::span(landmarks)));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  EXPECT_THAT(there.refused(), HasSubstr("lines that are no hands, and no hand within 300 ms"));
  end = true;
  sending.join();
}

TEST_P(HandDriver, AHeadsetThatDoesNotStreamIsSaid) {
  EXPECT_THAT(there.refused(),
              testing::AllOf(HasSubstr("no line within 300 ms; see that the headset streams"),
                             HasSubstr("that the left hand is in its view")));
  const FakeServer served(*there.server);
  there.table.side = "right";
  EXPECT_THAT(there.refused(), HasSubstr("only the other hand came within 300 ms"));
}

INSTANTIATE_TEST_SUITE_P(Each, HandDriver, testing::Values("udp", "tcp"),
                         [](const auto& one) { return one.param; });

// ---- the simulated hand tracker

// The tip of the index finger is where the hand is, to the noise of a frame.
TEST(SimulatedHand, HasRateLatencyAndNoise) {
  models::Setup setup = models::load(scene_file("tennis_ball"), "");
  setup.scene.hand_tracker.emplace();
  setup.rig.hand_tracker.driver = "sim";
  setup.twin.hand_tracker = {.latency = 0.040, .noise = 0.5e-3};
  const Twin twin(1, std::move(setup));
  ASSERT_NE(twin.rig.hand_tracker, nullptr);
  Measurement<HandSample> hand;
  const Pose<'W', 'L'> X_WL = Pose<'W', 'L'>::shift(-0.6, 0.08, 0.3);
  int news = 0;
  double sum = 0.0;
  std::vector<Vec3> true_tips;  // of each tick
  for (int i = 0; i < 2000; ++i) {
    const Tick tick = twin.rig.clock->next();
    const sim::Truth& truth = twin.world->truth();
    true_tips.push_back(Vec3(truth.tool_tip.e() - 0.06 * twin.world->pointing().e()));
    if (!twin.rig.hand_tracker->poll(tick.t, hand)) continue;
    ++news;
    EXPECT_EQ(tick.t - hand.t, from_seconds(0.040));
    const auto at = static_cast<std::size_t>(std::llround(1e3 * seconds(hand.t.time_since_epoch())));
    sum += ((X_WL * hand.value.joints[kIndexTip]).e() - true_tips[at]).squaredNorm();
    EXPECT_EQ(hand.value.skin, 0.008);
    EXPECT_TRUE(hand.value.wrist.valid());
  }
  EXPECT_NEAR(news, 2 * 120 - 5, 2);
  EXPECT_NEAR(std::sqrt(sum / (3.0 * news)), 0.5e-3, 0.05e-3);
}

// ---- foreign

const std::string kHandSdk = tests::source_dir() + "/.deps/hand_tracking_sdk";

class HandForeign : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kHandSdk)) GTEST_SKIP() << "no " << kHandSdk << ": ./check fetches it";
  }
  static std::vector<std::string> script(const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> all{"/usr/bin/python3", "-B",
                                 tests::source_dir() + "/tests/conformance/foreign/" + name, kHandSdk};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(HandForeign, TheSdkReceivesTheFakesHands) {
  for (const auto& [ours, theirs] : {std::pair{"udp", "udp"}, {"tcp", "tcp_client"}}) {
    HandPort there(ours);
    const FakeServer served(*there.server);
    const tests::Result result =
        tests::run(script("hand_sdk_client.py", {theirs, std::to_string(there.table.port)}));
    EXPECT_EQ(result.code, 0) << ours << result.out << result.err;
  }
}

// Lines that are right, and the same with some letters changed.
std::vector<std::string> mutated_lines() {
  const std::string lines = hand::lines_of({known_hand(), Time(from_seconds(5.0)), Health::ok}, 7, true);
  const std::vector<std::string> seeds{
      lines.substr(0, lines.find('\n')),
      lines.substr(lines.find('\n') + 1, lines.rfind('\n') - lines.find('\n') - 1),
      "Head pose | frame = 12 | ts=-5 | x: +1, 2.5e-3,.5,4.,,5,6 ,7", "Left wrist: 1,2,3,4,5,6,7",
      "Right WRIST||:1,2,3,4,5,6,7,"};
  const std::string letters = " \t|:=,.+-eE0127fFtTxLRHewist";
  std::mt19937 random(7);
  std::vector<std::string> all = seeds;
  for (int i = 0; i < 20'000; ++i) {
    std::string line = seeds[random() % seeds.size()];
    for (unsigned n = random() % 4; n > 0; --n) {
      const std::size_t at = random() % line.size();
      if (random() % 3 == 0)
        line.erase(at, 1);
      else if (random() % 2 == 0)
        line.insert(at, 1, letters[random() % letters.size()]);
      else
        line[at] = letters[random() % letters.size()];
    }
    all.push_back(line);
  }
  return all;
}

// Our words for a line, as hand_sdk_parser.py prints it; numbers to the last bit.
void expect_agreement(const std::string& line, const std::string& theirs) {
  constexpr const char* kSides[] = {"left", "right", "head"};
  constexpr const char* kKinds[] = {"wrist", "landmarks", "pose"};
  hand::Packet packet;
  const bool ours = hand::read(line, packet) == hand::LineFault::nothing;
  // Beyond the range of a double theirs is 0 or infinite, and ours refused.
  if (!ours && (theirs.find("inf") != std::string::npos || theirs.find("nan") != std::string::npos)) return;
  ASSERT_EQ(ours, theirs != "no") << line << " | " << theirs;
  if (!ours) return;
  std::istringstream words(theirs);
  std::string side, kind, frame, stamp;
  words >> side >> kind >> frame >> stamp;
  const auto text = [](const auto& number) { return number ? std::to_string(*number) : std::string("None"); };
  EXPECT_EQ(side, kSides[static_cast<std::size_t>(packet.side)]);
  EXPECT_EQ(kind, kKinds[static_cast<std::size_t>(packet.kind)]);
  EXPECT_EQ(frame, text(packet.frame)) << line;
  EXPECT_EQ(stamp, text(packet.stamp_ns)) << line;
  for (std::size_t i = 0; i < packet.count; ++i) {
    std::string value;
    words >> value;
    EXPECT_EQ(std::stod(value), packet.values[i]) << line;
  }
}

TEST_F(HandForeign, ItsParserAndOursAgreeOnTheSameLines) {
  const TemporaryFolder folder;
  const std::vector<std::string> lines = mutated_lines();
  {
    std::ofstream out(folder.file("lines"), std::ios::binary);
    for (const std::string& line : lines) out << line << '\n';
  }
  const tests::Result result = tests::run(script("hand_sdk_parser.py", {folder.file("lines")}));
  ASSERT_EQ(result.code, 0) << result.err;
  std::istringstream said(result.out);
  std::string theirs;
  std::size_t accepted = 0;
  for (const std::string& line : lines) {
    ASSERT_TRUE(std::getline(said, theirs));
    accepted += theirs == "no" ? 0 : 1;
    expect_agreement(line, theirs);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(accepted, lines.size() / 10);
  EXPECT_LT(accepted, lines.size() * 9 / 10);
}

}  // namespace
}  // namespace enc::test
