// The driver of LeapC against its fake library over loopback, and against a library that a test scripts.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>
#include <random>
#include <regex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/hand/fake/server.h"
#include "hw_drivers/leap/drive/leap_tracker.h"
#include "hw_drivers/leap/wire/hand_of.h"
#include "hw_drivers/net/clocks.h"
#include "tests/support/built.h"
#include "tests/support/devices.h"
#include "tests/support/error_of.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

namespace leapc = leap::leapc;
using testing::AllOf;
using testing::HasSubstr;

// A hand that a test knows: a quarter turn about z, and each joint at another place.
HandSample leap_hand() {
  HandSample hand;
  hand.side = HandSide::left;
  hand.wrist = {Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ())), Vec3(0.1, -0.2, 0.3)};
  hand.joints[0] = Point<'L'>(hand.wrist.p());
  for (std::size_t i = 1; i < kHandJoints; ++i) {
    const double n = static_cast<double>(i);
    hand.joints[i] = hand.wrist * Point<'K'>(0.01 * n, 0.001 * n, -0.002 * n);
  }
  hand.skin = 0.008;
  return hand;
}

// Single precision of mm.
constexpr double kFloat = 1e-7;
void expect_equal(const HandSample& hand, const HandSample& other) {
  EXPECT_EQ(hand.side, other.side);
  EXPECT_LT((hand.wrist.p() - other.wrist.p()).norm(), kFloat);
  EXPECT_LT(hand.wrist.q().angularDistance(other.wrist.q()), 1e-3);
  for (std::size_t i = 0; i < kHandJoints; ++i)
    EXPECT_LT((hand.joints[i] - other.joints[i]).norm(), kFloat) << i;
  EXPECT_NEAR(hand.skin, other.skin, kFloat);
}

// ---- hands

TEST(LeapHand, HasItsJointsInOurOrderAndInMetres) {
  leapc::Hand said = leap::said_of(leap_hand());
  said.digits[1].bones[3].end = {{10, 20, 30}};
  said.digits[0].bones[1].begin = {{1, 2, 3}};
  said.digits[4].bones[2].end = {{4, 5, 6}};
  HandSample hand;
  ASSERT_TRUE(leap::hand_of(said, hand));
  EXPECT_LT((hand.joints[kIndexTip].e() - Vec3(0.01, 0.02, 0.03)).norm(), kFloat);
  EXPECT_LT((hand.joints[1].e() - Vec3(0.001, 0.002, 0.003)).norm(), kFloat) << "root of the thumb";
  EXPECT_LT((hand.joints[19].e() - Vec3(0.004, 0.005, 0.006)).norm(), kFloat) << "before the last tip";
}

TEST(LeapHand, GoesThereAndBack) {
  HandSample hand;
  ASSERT_TRUE(leap::hand_of(leap::said_of(leap_hand()), hand));
  expect_equal(hand, leap_hand());
}

TEST(LeapHand, ThatCannotBeIsRefused) {
  const leapc::Hand good = leap::said_of(leap_hand());
  HandSample hand;
  for (const float wrong :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e5F}) {
    for (int part = 0; part < 3; ++part) {
      leapc::Hand said = good;
      (part == 0   ? said.arm.end.v[1]
       : part == 1 ? said.digits[2].bones[2].end.v[0]
                   : said.palm.orientation.w) = wrong;
      EXPECT_FALSE(leap::hand_of(said, hand)) << wrong << " in " << part;
    }
  }
  leapc::Hand said = good;
  said.digits[1].bones[3].width = -1;
  EXPECT_FALSE(leap::hand_of(said, hand));
}

// ---- the driver, with a library that a test scripts

// One process has one library. Its messages are those that a test puts in.
struct Script {
  struct Entry {
    std::uint32_t type = 0;
    leapc::TrackingEvent frame{};
    leapc::Hand hand{};
  };
  void begin(std::vector<std::uint32_t> first) {
    const std::lock_guard lock(mutex);
    entries.clear();
    for (const std::uint32_t type : first) entries.push_back({type});
    result = leapc::kTimeout;
    throws = hangs = false;
    frames = 0;
    modes = 0;
    late = 0.0;
  }
  // A frame with this hand, which was exposed at this time of the library's clock; without one if `hand` is
  // null.
  void put_frame(double exposed, const HandSample* hand) {
    Entry entry{leapc::kTracking};
    entry.frame.info.frame = ++frames;
    entry.frame.info.timestamp = std::llround(1e6 * exposed);
    if (hand != nullptr) entry.hand = leap::said_of(*hand);
    entry.frame.hands_count = hand != nullptr ? 1 : 0;
    put(entry);
  }
  void put(const Entry& entry) {
    const std::lock_guard lock(mutex);
    entries.push_back(entry);
  }
  void put(std::uint32_t type) { put(Entry{type}); }

  std::mutex mutex;
  std::deque<Entry> entries;
  Entry now_out;
  leapc::DeviceEvent device;
  std::atomic<leapc::Result> result = leapc::kTimeout;  // of a poll without a message
  std::atomic<bool> throws = false, hangs = false;
  std::atomic<std::int64_t> frames = 0;
  std::atomic<std::uint32_t> modes = 0;  // the last mode and 1
  std::atomic<double> ahead = 0.0, fast = 0.0;
  std::atomic<double> late = 0.0;  // s that pass after the library's clock was read, in virtual time
  [[nodiscard]] double clock(Duration steady) const { return ahead + (1.0 + fast) * seconds(steady); }
};
Script& script() {
  static Script the;
  return the;
}

leapc::Result poll_script(leapc::Connection, std::uint32_t, leapc::Message* to) {
  Script& of = script();
  if (of.throws) throw std::runtime_error("as a test asks for");
  while (of.hangs) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::lock_guard lock(of.mutex);
  if (of.entries.empty()) {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
    return of.result;
  }
  of.now_out = of.entries.front();
  of.entries.pop_front();
  of.now_out.frame.hands = &of.now_out.hand;
  const void* event = of.now_out.type == leapc::kTracking ? static_cast<const void*>(&of.now_out.frame)
                      : of.now_out.type == leapc::kDevice ? &of.device
                                                          : nullptr;
  *to = {sizeof(leapc::Message), of.now_out.type, event, 1};
  return leapc::kSuccess;
}

leapc::Functions scripted() {
  leapc::Functions of;
  of.create = [](const leapc::ConnectionConfig*, leapc::Connection*) { return leapc::kSuccess; };
  of.open = [](leapc::Connection) { return leapc::kSuccess; };
  of.poll = poll_script;
  of.close = [](leapc::Connection) {};
  of.destroy = [](leapc::Connection) {};
  of.now = [] {
    const Duration steady = net::steady_now();
    if (script().late > 0.0) net::stand_at(steady + from_seconds(script().late));
    return static_cast<std::int64_t>(std::llround(1e6 * script().clock(steady)));
  };
  of.set_mode = [](leapc::Connection, std::uint32_t mode) {
    script().modes = mode + 1;
    return leapc::kSuccess;
  };
  of.open_device = [](leapc::DeviceReference, leapc::Device*) { return leapc::kSuccess; };
  of.device_info = [](leapc::Device, leapc::DeviceInfo* info) {
    constexpr std::string_view kSerial = "LP0815";
    kSerial.copy(info->serial, kSerial.size());
    return leapc::kSuccess;
  };
  of.close_device = [](leapc::Device) {};
  return of;
}

class LeapDriver : public testing::Test {
 protected:
  LeapDriver() {
    settings.side = "left";
    settings.timeout = 0.2;
    settings.silent = 0.1;
    script().begin({leapc::kConnection, leapc::kDevice});
    script().ahead = 100.0;
    script().fast = 0.0;
    put_now(nullptr);
  }
  std::unique_ptr<leap::LeapTracker> driver() {
    return std::make_unique<leap::LeapTracker>(offer.with(), settings, scripted());
  }
  std::string refused() {
    return error_of([&] { driver(); }, ErrorKind::device);
  }
  // A frame that is 20 ms old.
  static void put_now(const HandSample* hand) {
    script().put_frame(script().clock(net::steady_now()) - 0.020, hand);
  }
  [[nodiscard]] Time now() const { return Time(net::steady_now() - begun); }
  // Polls until it gives a hand, or this long.
  bool comes(HandTracker& from, double within = 1.0) {
    for (const Duration until = net::steady_now() + from_seconds(within); net::steady_now() < until;) {
      if (from.poll(now(), newest)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  // The first poll discards what came before the run.
  std::unique_ptr<leap::LeapTracker> running() {
    auto made = driver();
    made->poll(now(), newest);
    return made;
  }
  double worst_in_a_run(leap::LeapTracker& made, Duration& at);
  DefaultOffer offer;
  leap::LeapSettings settings;
  Duration begun = net::steady_now();
  Measurement<HandSample> newest;
  const HandSample hand = leap_hand();
};

// "its clock is 100.0000 s ahead of the run's, 80.0 ppm fast"
void find_clock(const std::string& remark, double& ahead, double& drift, std::string& way) {
  std::smatch found;
  ASSERT_TRUE(std::regex_search(
      remark, found, std::regex("its clock is ([0-9.]+) s ahead of the run's, ([0-9.]+) ppm (fast|slow)")))
      << remark;
  ahead = std::stod(found[1]);
  drift = std::stod(found[2]);
  way = found[3];
}

TEST_F(LeapDriver, GivesTheHandWithTheTimeOfItsExposure) {
  const auto made = running();
  EXPECT_EQ(made->describe(), "left hand of Leap device 'LP0815', answered");
  EXPECT_FALSE(made->is_fake());
  EXPECT_EQ(script().modes, 2U) << "on a headset";
  const Time exposed = now() - from_seconds(0.020);
  put_now(&hand);
  ASSERT_TRUE(comes(*made));
  expect_equal(newest.value, hand);
  EXPECT_NEAR(age(newest.t, exposed), 0.0, 0.005);
  EXPECT_EQ(newest.health, Health::ok);
}

TEST_F(LeapDriver, AFrameWithoutTheHandKeepsTheLink) {
  settings.silent = 10.0;  // s: a busy machine is slow
  const auto made = running();
  HandSample other = hand;
  other.side = HandSide::right;
  for (int i = 1; i <= 10; ++i) {
    put_now(i % 2 == 0 ? nullptr : &other);
    const std::string said = std::to_string(i) + " frames, 0 with the hand, 0 missing, 0 wrong";
    for (int turn = 0; turn < 500 && made->remarks().at(0).find(said) == std::string::npos; ++turn)
      EXPECT_FALSE(comes(*made, 0.01));
    EXPECT_THAT(made->remarks().at(0), HasSubstr(said));
    EXPECT_TRUE(made->linked());
  }
}

TEST_F(LeapDriver, AFrameThatIsMissingWrongOrLateIsCounted) {
  const auto made = running();
  put_now(&hand);
  ASSERT_TRUE(comes(*made));
  script().frames += 3;
  put_now(&hand);
  ASSERT_TRUE(comes(*made));
  const double clock = script().clock(net::steady_now());
  for (const double wrong : {clock + 60.0, clock - 2.0, 1e13, -1e13}) {  // s, of the library's clock
    script().put_frame(wrong, &hand);
    EXPECT_FALSE(comes(*made, 0.02)) << wrong;
  }
  script().frames = std::numeric_limits<std::int64_t>::max() - 6;  // a new service, and its numbers end
  put_now(&hand);
  ASSERT_TRUE(comes(*made));
  script().frames += 4;
  put_now(&hand);
  ASSERT_TRUE(comes(*made));
  HandSample far = hand;
  far.joints[5] = Point<'L'>(0, 0, 1000);
  put_now(&far);
  EXPECT_FALSE(comes(*made, 0.02));
  EXPECT_THAT(made->remarks().at(0), HasSubstr("9 frames, 4 with the hand, 7 missing, 5 wrong"));
}

TEST_F(LeapDriver, FramesThatStayAwayLoseTheLinkUntilTheyCome) {
  const auto made = running();
  EXPECT_FALSE(comes(*made, 0.05));
  EXPECT_TRUE(made->linked());
  EXPECT_FALSE(comes(*made, 0.1));
  EXPECT_FALSE(made->linked());
  put_now(&hand);
  ASSERT_TRUE(comes(*made));
  EXPECT_TRUE(made->linked());
  EXPECT_THAT(made->remarks().at(0), HasSubstr("; link lost 1 times"));
}

TEST_F(LeapDriver, ADeviceThatIsLostLosesTheLinkAtOnce) {
  for (const std::uint32_t end : {leapc::kDeviceLost, leapc::kDeviceFailure, leapc::kConnectionLost}) {
    script().begin({leapc::kConnection, leapc::kDevice});
    put_now(nullptr);
    const auto made = running();
    script().put(end);
    EXPECT_FALSE(comes(*made, 0.03));
    EXPECT_FALSE(made->linked()) << end;
    script().put(leapc::kDevice);
    put_now(&hand);
    ASSERT_TRUE(comes(*made));
    EXPECT_TRUE(made->linked());
    EXPECT_THAT(made->remarks().at(0), HasSubstr("; device lost 1 times"));
  }
}

TEST_F(LeapDriver, ALibraryThatThrowsEndsTheLink) {
  const auto made = running();
  script().throws = true;
  EXPECT_FALSE(comes(*made, 0.05));
  EXPECT_FALSE(made->linked());
  EXPECT_THAT(made->remarks().at(0), HasSubstr("last: the vendor's library threw an exception"));
}

TEST_F(LeapDriver, ALibraryThatHangsEndsTheLinkAndHoldsNothingUp) {
  auto made = running();
  script().hangs = true;
  EXPECT_FALSE(comes(*made, 0.2));
  EXPECT_FALSE(made->linked());
  const Duration before = net::steady_now();
  made.reset();
  EXPECT_LT(seconds(net::steady_now() - before), 1.0);
  script().hangs = false;
}

TEST_F(LeapDriver, WhatDoesNotAnswerIsSaid) {
  script().begin({});
  script().result = leapc::kNotConnected;
  EXPECT_THAT(refused(), AllOf(HasSubstr("LeapC: no tracking service answers within 200 ms "
                                         "(eLeapRS_NotConnected (0xe2010005))"),
                               HasSubstr("ultraleap-hand-tracking-service runs")));
  script().begin({leapc::kConnection});
  EXPECT_THAT(refused(),
              HasSubstr("the tracking service has no device within 200 ms; see the device's cable"));
  script().begin({leapc::kConnection, leapc::kDevice});
  EXPECT_THAT(refused(), HasSubstr("the device sends no frame within 200 ms; see"));
  script().begin({});
  script().throws = true;
  EXPECT_THAT(refused(), HasSubstr("(the vendor's library threw an exception)"));
  script().begin({});
}

// A run of 36 s in virtual time, at 120 frames a second. Each four seconds the two clocks are read at once,
// else up to 10 ms apart, so that a drift is only found over many seconds. Returns the largest error of an
// exposure in the second half, s.
double LeapDriver::worst_in_a_run(leap::LeapTracker& made, Duration& at) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> late(0.0, 0.010);
  constexpr int kFrames = 120 * 36;
  double worst = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    at += from_seconds(1.0 / 120);
    net::stand_at(at);
    script().late = i % 480 == 0 ? 0.0 : late(random);
    const Duration exposed = at - from_seconds(0.020);
    script().put_frame(script().clock(exposed), &hand);
    bool news = false;
    for (int turn = 0; turn < 100'000 && !news; ++turn) {
      news = made.poll(now(), newest);
      if (!news) std::this_thread::yield();
    }
    EXPECT_TRUE(news) << i;
    if (!news) break;
    if (i > kFrames / 2) worst = std::max(worst, std::abs(age(newest.t, Time(exposed - begun))));
  }
  net::stand_at({});
  return worst;
}

// Its clock is 100 s ahead, and gains or loses 80 ppm. A clock that gains would hide a drift that is not
// estimated: each new message is then the quickest.
TEST_F(LeapDriver, FindsOffsetAndDriftOfTheClock) {
  for (const double fast : {80e-6, -80e-6}) {
    script().begin({leapc::kConnection, leapc::kDevice});
    put_now(nullptr);
    script().fast = fast;
    Duration at = net::steady_now();
    begun = at;
    const auto made = running();
    EXPECT_LT(worst_in_a_run(*made, at), 0.1e-3) << fast;
    double ahead = 0.0, drift = 0.0;
    std::string way;
    find_clock(made->remarks().at(0), ahead, drift, way);
    EXPECT_NEAR(ahead, script().clock(at) - seconds(at - begun), 0.15e-3) << "its last digit is 0.1 ms";
    EXPECT_NEAR(drift, 80.0, 2.0);
    EXPECT_EQ(way, fast > 0 ? "fast" : "slow");
  }
}

// ---- the library

struct LeapTable final : DefaultOffer::Defaults {
  using DefaultOffer::Defaults::value;
  void value(const Setting& key, double& number) override {
    if (key.name == "timeout_ms") number = 0.3;
  }
  void value(const Setting& key, std::string& text) override {
    if (key.name == "library") text = library;
    if (key.name == "server") text = server;
    if (key.name == "side") text = "left";
  }
  std::string library = "fake", server;
};

class LeapLibrary : public testing::Test {
 protected:
  LeapLibrary() { setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1); }
  ~LeapLibrary() override { unsetenv("ENCOUNTER_MODULES"); }
  std::unique_ptr<HandTracker> driver() {
    return leap::opened({table, defaults.rig, defaults.reach, Duration(1'000'000), defaults.log});
  }
  std::string refused() {
    return error_of([&] { static_cast<void>(driver()); }, ErrorKind::device);
  }
  DefaultOffer defaults;
  LeapTable table;
};

TEST_F(LeapLibrary, ThatIsMissingIsSaidWithTheWayOut) {
  table.library = "/nowhere/libLeapC.so";
  EXPECT_EQ(
      refused(),
      "/nowhere/libLeapC.so: cannot open shared object file: No such file or directory; expected the hand "
      "tracking software 5 of Ultraleap; install it, or set driver.leap.library to its file, to \"fake\" "
      "for the fake");
  table.library.clear();
  EXPECT_THAT(refused(), AllOf(HasSubstr("libLeapC.so"), HasSubstr("to \"fake\" for the fake")));
}

TEST_F(LeapLibrary, OfAnotherProductLacksAFunction) {
  table.library = "libm.so.6";
  EXPECT_THAT(refused(),
              HasSubstr("libm.so.6 lacks LeapCreateConnection: it is too old, or another library"));
}

// The library of version 4 has no tracking modes: the fake, with another name in place of that function.
TEST_F(LeapLibrary, ThatIsTooOldLacksAFunction) {
  std::string bytes = bytes_of(std::filesystem::path(tests::module_folder()) / "fakes" / "libLeapC.so");
  const std::string name = "LeapSetTrackingMode";
  ASSERT_NE(bytes.find(name), std::string::npos);
  for (std::size_t at = bytes.find(name); at != std::string::npos; at = bytes.find(name, at)) bytes[at] = 'l';
  const TemporaryFolder folder;
  table.library = folder.file("libLeapC_old.so");
  std::ofstream(table.library, std::ios::binary) << bytes;
  EXPECT_THAT(refused(), AllOf(HasSubstr("libLeapC_old.so lacks LeapSetTrackingMode: it is too old"),
                               HasSubstr("expected the hand tracking software 5 of Ultraleap")));
}

TEST_F(LeapLibrary, OfTheFakeGivesTheHandThatTheFakeSends) {
  struct KnownTracker final : HandTracker {
    bool poll(Time now, Measurement<HandSample>& newest) noexcept override {
      constexpr Duration kFrame{8'333'333};
      if (now - last < kFrame) return false;
      last = now;
      newest = {leap_hand(), now, Health::ok};
      return true;
    }
    Time last{};
  } known;
  hand::HandSettings lines;
  lines.address = "127.0.0.1";
  lines.port = net::bind_udp("127.0.0.1", 0).port();
  table.server = lines.place();
  EXPECT_THAT(refused(), HasSubstr("the device sends no frame within 300 ms"));
  hand::Server server(known, lines, 1, "Leap device");
  const FakeServer served(server);
  const auto made = driver();
  EXPECT_TRUE(made->is_fake());
  Measurement<HandSample> newest;
  int news = 0;
  double youngest = 1.0;  // s
  const Duration begun = net::steady_now();
  for (int i = 0; i < 20'000 && news < 20; ++i) {
    const Time now(net::steady_now() - begun);
    if (made->poll(now, newest)) {
      ++news;
      youngest = std::min(youngest, age(now, newest.t));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(news, 20);
  EXPECT_NEAR(youngest, 0.030, 0.01) << "the fake's lines are as old as those of a headset";
  HandSample expected = leap_hand();
  expect_equal(newest.value, expected);
  EXPECT_TRUE(made->linked());
}

// ---- over the program

TEST(LeapProgram, DevicesListsItBeforeItsFake) {
  const std::string scene = tests::source_dir() + "/models/scenes/camera/wall.toml";
  const std::string port = std::to_string(net::bind_udp("127.0.0.1", 0).port());
  const std::vector<std::string> set{"--scene", scene,
                                     "--set",   "rig.hand_tracker.driver=leap",
                                     "--set",   "rig.driver.leap.library=fake",
                                     "--set",   "rig.driver.leap.server=127.0.0.1:" + port};
  std::vector<std::string> fake{tests::program_file(), "fake", "vishap"},
      asked{"devices", "vishap", "--for-s", "0.6"};
  fake.insert(fake.end(), set.begin(), set.end());
  asked.insert(asked.end(), set.begin(), set.end());
  tests::PipedChild fakes(fake);
  std::string said;
  std::array<char, 256> bytes{};
  for (int i = 0; i < 600 && !fakes.closed() && said.find("ends with SIGINT") == std::string::npos; ++i)
    said.append(bytes.data(), fakes.read(bytes, 100));
  EXPECT_THAT(said, HasSubstr("Leap device that sends hands to 127.0.0.1:" + port));
  const tests::Result result = tests::run_program(asked, tests::kShipped, 60);
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("right hand of Leap device 'Encounter fake', answered (a fake)"),
                                HasSubstr("of the right wrist in L"), HasSubstr("samples a second"),
                                HasSubstr(" with the hand, "), HasSubstr(" missing, 0 wrong")));
}

}  // namespace
}  // namespace enc::test
