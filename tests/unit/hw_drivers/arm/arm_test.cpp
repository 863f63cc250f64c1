// What all force-controlled arms share: when a force passes to the device, how a vendor's library is loaded,
// and the datagrams of the fakes.
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/arm/fake/message.h"
#include "hw_drivers/arm/force_guard.h"
#include "hw_drivers/arm/library.h"
#include "hw_drivers/arm/servo.h"
#include "hw_drivers/net/clocks.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"
#include "trial/devices/device_log.h"

namespace enc::arm {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr Duration kMs{1'000'000};

// A loop that commands 4 N in each period of 1 ms, and the device's thread, half a period later.
struct GuardRun {
  explicit GuardRun(const GuardLimits& limits = {}) : guard(limits) {}
  double next(bool commands = true, bool pressed = true, bool error = false) {
    now += kMs;
    if (commands) order = {wanted, now, order.number + 1, false};
    return guard.pass(now + kMs / 2, order, pressed, error).norm();
  }
  void run(int periods) {
    for (int i = 0; i < periods; ++i) next();
  }
  ForceGuard guard;
  ForceOrder order;
  Vec<'R'> wanted{0, 0, 4};
  Duration now = 100 * kMs;
};

TEST(ForceGuard, WithoutACommandThereIsNoForce) {
  GuardRun there;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(there.next(false), 0.0);
  EXPECT_EQ(there.guard.counts().watchdog, 0);
}

TEST(ForceGuard, TheForceGrowsFromZeroToWhatTheLoopCommands) {
  GuardRun there;
  there.next(false);
  for (int ms = 1; ms < 200; ++ms) EXPECT_NEAR(there.next(), 0.020 * ms, 1e-12) << ms;
  there.run(2);
  EXPECT_DOUBLE_EQ(there.next(), 4.0);
  EXPECT_NEAR(there.guard.pass(there.now, {Vec<'R'>(3, 0, 4), there.now, 999, false}, true, false).norm(),
              0.020 * 201.5, 1e-9)
      << "the direction stays, the norm is limited";
}

TEST(ForceGuard, WithoutARampTheForceComesAtOnce) {
  GuardLimits limits;
  limits.rise = 0.0;
  GuardRun there(limits);
  EXPECT_EQ(there.next(), 4.0);
}

// Three periods of 1 ms without a command, and at most one more until the device's thread comes.
TEST(ForceGuard, ASilentLoopMeansNoForceWithinFiveMilliseconds) {
  GuardRun there;
  there.run(500);
  ASSERT_EQ(there.next(), 4.0);
  const Duration last = there.order.given;
  double force = 4.0;
  while (force > 0.0) force = there.next(false);
  EXPECT_LE(seconds(there.now + kMs / 2 - last), 0.005);
  EXPECT_GE(seconds(there.now + kMs / 2 - last), 0.003);
  EXPECT_EQ(there.guard.counts().watchdog, 1);
  there.next(false);
  EXPECT_EQ(there.guard.counts().watchdog, 1) << "counted once";
  EXPECT_LT(there.next(), 0.03) << "it begins anew with the ramp";
}

TEST(ForceGuard, AStopEndsTheForceAtOnce) {
  GuardRun there;
  there.run(500);
  there.order.stopped = true;
  EXPECT_EQ(there.guard.pass(there.now, there.order, true, false).norm(), 0.0);
  EXPECT_EQ(there.guard.counts().watchdog, 0);
}

TEST(ForceGuard, AnOpenSwitchMeansNoForceAndTheRampAfterwards) {
  GuardRun there;
  there.run(500);
  EXPECT_EQ(there.next(true, false), 0.0);
  EXPECT_EQ(there.next(true, false), 0.0);
  EXPECT_EQ(there.guard.counts().released, 1);
  EXPECT_NEAR(there.next(), 0.020, 1e-12);
  there.run(300);
  EXPECT_EQ(there.next(), 4.0);
}

// One reading with an error ends the force for half a second.
TEST(ForceGuard, AnErrorOfTheDeviceMeansNoForceUntilItWasQuietForAWhile) {
  GuardRun there;
  there.run(500);
  EXPECT_EQ(there.next(true, true, true), 0.0);
  for (int ms = 1; ms < 500; ++ms) ASSERT_EQ(there.next(), 0.0) << ms;
  EXPECT_NEAR(there.next(), 0.020, 1e-12);
}

TEST(ForceGuard, NoForceIsBeyondTheDevicesLimit) {
  GuardLimits limits;
  limits.most = 3.0;
  GuardRun there(limits);
  there.run(500);
  EXPECT_NEAR(there.next(), 3.0, 1e-12);
  EXPECT_GT(there.guard.counts().clipped, 400);
}

// ---- the device's thread

// A stopped process wakes all its threads at once: the turn may come before the watch looks.
TEST(ArmServo, ATurnThatComesTooLateExertsNoForceAndEndsTheLink) {
  ServoSettings settings;
  settings.guard.rise = 0.0;
  settings.guard.watchdog = 1.0;  // the loop's command is fresh
  settings.watched = false;
  trial::DeviceLog log;
  int cuts = 0;
  Servo servo(
      settings, log, [&] { ++cuts; }, [](int) { return std::string("an error"); });
  ArmReading reading;
  reading.at = net::steady_now();
  static_cast<void>(servo.turn(reading));
  static_cast<void>(servo.read(Time{}));
  servo.command(Vec<'R'>(0, 0, 1));
  reading.at += 4 * kMs;
  EXPECT_EQ(servo.turn(reading).norm(), 1.0) << "just in time";
  EXPECT_TRUE(servo.linked());
  reading.at += 4 * kMs + Duration(1);
  EXPECT_EQ(servo.turn(reading).norm(), 0.0);
  EXPECT_FALSE(servo.linked());
  EXPECT_EQ(cuts, 1);
  reading.at += kMs;
  EXPECT_EQ(servo.turn(reading).norm(), 0.0) << "until a new run";
  EXPECT_EQ(servo.read(Time{}).health, Health::fault);
  EXPECT_THAT(log.lines(), testing::ElementsAre(HasSubstr("its own thread came too late")));
}

// ---- the library

LibraryRequest request(const std::string& chosen) {
  return {{"libNobodyHasThis.so", "libNorThis.so"}, chosen, "driver.mine.library", "the SDK of a vendor"};
}

TEST(VendorLibrary, AMissingOneIsOneLineWithTheWayOut) {
  EXPECT_THAT(test::refusal(ErrorKind::device, [] { Library library(request("")); }),
              AllOf(HasSubstr("libNobodyHasThis.so: cannot open"), HasSubstr("expected the SDK of a vendor"),
                    HasSubstr("set driver.mine.library"), testing::Not(HasSubstr("\n"))));
  EXPECT_THAT(test::refusal(ErrorKind::device, [] { Library library(request("/nowhere/lib.so")); }),
              HasSubstr("/nowhere/lib.so: cannot open"));
  EXPECT_THAT(test::refusal(ErrorKind::device, [] { Library library(request(kFakeLibrary)); }),
              HasSubstr("there is no fake libNobodyHasThis.so beside the modules"));
}

// Several names are tried: the file that is there gives the reason.
TEST(VendorLibrary, AFileThatDoesNotLoadIsNamedBeforeOneThatIsAbsent) {
  const test::TemporaryFolder folder;
  const std::string broken = folder.file("libNobodyHasThis.so.3");
  std::ofstream(broken) << "not a library, but long enough to be read as one: it has no header of ELF";
  LibraryRequest several = request("");
  several.files = {"libNobodyHasThis.so", broken, "libNorThis.so"};
  EXPECT_THAT(test::refusal(ErrorKind::device, [&] { Library library(several); }),
              AllOf(HasSubstr(broken), HasSubstr("invalid ELF header")));
}

TEST(VendorLibrary, ALackingSymbolIsNamed) {
  const Library libc(request("libc.so.6"));
  EXPECT_EQ(libc.file(), "libc.so.6");
  int (*absolute)(int) = nullptr;
  libc.find("abs", absolute);
  EXPECT_EQ(absolute(-3), 3);
  EXPECT_THAT(test::refusal(ErrorKind::device, [&] { libc.find("hdInitDevice", absolute); }),
              HasSubstr("libc.so.6 lacks hdInitDevice: it is too old, or another library"));
}

// ---- the datagrams of the fakes

TEST(ArmMessages, ComeThroughAndNothingElseDoes) {
  State state;
  state.number = 7;
  state.tip = {0.1, 0.2, 0.3};
  const auto bytes = bytes_of(state);
  State got;
  ASSERT_TRUE(read(bytes, got));
  EXPECT_EQ(got.number, 7U);
  EXPECT_EQ(got.tip, state.tip);
  Command command;
  EXPECT_FALSE(read(bytes, command));
  command.header.message = Message::force;
  command.force = {1, 2, 3};
  Command back;
  ASSERT_TRUE(read(bytes_of(command), back));
  EXPECT_EQ(back.force, command.force);
  EXPECT_FALSE(read(std::span(bytes).first(bytes.size() - 1), got));
  EXPECT_FALSE(read(std::span<const std::byte>(), got));
  command.header.message = Message::state;  // not for this direction
  EXPECT_FALSE(read(bytes_of(command), back));
}

TEST(ArmMessages, NoBytesDoHarm) {
  std::mt19937_64 random(5);
  const auto whole = bytes_of(State{});
  std::int64_t taken = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::byte> bytes(whole.begin(), whole.end());
    if (i % 2 == 0) bytes.resize(random() % (sizeof(State) + 2));
    for (int k = 0; k < 3 && !bytes.empty(); ++k)
      bytes[random() % bytes.size()] = static_cast<std::byte>(random() & 0xffU);
    State state;
    Command command;
    taken += read(bytes, state) ? 1 : 0;
    static_cast<void>(read(bytes, command));
  }
  EXPECT_GT(taken, 1000) << "most mutations hit numbers, which may be any";
}

TEST(ArmMessages, APlaceIsAHostAndAPort) {
  Place place;
  EXPECT_TRUE(read_place("127.0.0.1:18970", place));
  EXPECT_EQ(place.host, "127.0.0.1");
  EXPECT_EQ(place.port, 18970);
  for (const char* text : {"", "Default Device", ":1", "host:", "host:0", "host:65536", "host:12x"})
    EXPECT_FALSE(read_place(text, place)) << text;
}

}  // namespace
}  // namespace enc::arm
