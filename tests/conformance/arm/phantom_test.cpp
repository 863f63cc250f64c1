// The driver of a PHANToM against the fake libHD.so.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/arm/phantom_bench.h"
#include "tests/support/refusal.h"
#include "tests/support/twin.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

const Vec<'R'> kPush(1.0, -2.0, 3.0);

TEST(Phantom, SaysWhatItIsAndWhereItsTipIs) {
  PhantomBench there;
  const auto driver = there.open();
  EXPECT_TRUE(driver->is_fake());
  EXPECT_EQ(driver->describe(),
            "Encounter fake PHANToM Premium 1.0A F0001, HD 3.4.0, driver 2023.11.15, calibrated");
  EXPECT_EQ(driver->ability().peak, 8.5);
  EXPECT_EQ(driver->ability().continuous, 1.4);
  const auto sample = driver->read(Time(net::steady_now()));
  EXPECT_EQ(sample.health, Health::ok);
  EXPECT_EQ(sample.value.joints, there.arm.joints) << "to the bit";
  EXPECT_EQ(sample.value.tip.xyz, there.arm.arm.tip(there.arm.joints).xyz);
  EXPECT_LT((sample.value.velocity - Vec<'R'>(0.1, -0.2, 0.3)).norm(), 1e-15);
  EXPECT_TRUE(driver->linked());
}

// The motors are off, and stay so without a command.
TEST(Phantom, OpeningAndReadingMovesNothing) {
  PhantomBench there;
  const auto driver = there.open();
  for (int i = 0; i < 50; ++i) {
    static_cast<void>(driver->read(Time(net::steady_now())));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_FALSE(there.motors_on());
  EXPECT_EQ(there.with([&] { return there.server.forces(); }), 0);
}

TEST(Phantom, ExertsTheForceThatItIsGivenAndStops) {
  PhantomBench there;
  auto driver = there.open();
  ASSERT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().xyz == kPush.xyz; }))
      << "to the bit";
  EXPECT_TRUE(there.motors_on());
  driver->stop();
  EXPECT_TRUE(there.until([&] { return there.force().norm() == 0.0 && !there.motors_on(); })) << "braked";
  driver->stop();
  ASSERT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().xyz == kPush.xyz; })) << "anew";
  driver.reset();
  EXPECT_TRUE(there.until([&] { return there.force().norm() == 0.0; }));
  EXPECT_TRUE(there.until([&] { return !there.log.lines().empty(); }));
  EXPECT_THAT(there.log.lines(), Contains(HasSubstr("the client is gone; it commanded")));
}

TEST(Phantom, TheForceRisesWithTheRamp) {
  PhantomBench there;
  there.table.rise = 10.0;  // N/s: 3.7 N after 0.37 s
  const auto driver = there.open();
  const Duration begun = net::steady_now();
  Duration low = begun;
  ASSERT_TRUE(there.push_until(*driver, kPush, [&] {
    if (there.force().norm() < 2.0) low = net::steady_now();
    return there.force().xyz == kPush.xyz;
  }));
  EXPECT_GE(seconds(net::steady_now() - begun), 0.37);
  EXPECT_GE(seconds(low - begun), 0.19);
}

TEST(Phantom, NotANumberIsRefusedAndSaid) {
  PhantomBench there;
  const auto driver = there.open();
  ASSERT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().norm() > 0.0; }));
  driver->command(Vec<'R'>(kUnset, 0, 0));
  EXPECT_EQ(driver->read(Time(net::steady_now())).health, Health::fault);
  driver->command(kPush);
  EXPECT_EQ(driver->read(Time(net::steady_now())).health, Health::ok);
}

// A loop that stalls: three of its periods, then the device's next reading. The margin is what this busy
// machine adds: the longest time between two readings.
TEST(Phantom, ASilentLoopMeansNoForceWithinFiveMilliseconds) {
  PhantomBench there;
  there.table.watchdog_periods = 3;
  const auto driver = there.open();
  double best = 1.0;  // s
  for (int i = 0; i < 20 && best > 0.005; ++i) {
    ASSERT_TRUE(there.push_until(*driver, kPush, [&] { return there.zero_since == 0; }));
    const Duration last = net::steady_now();
    ASSERT_TRUE(there.until([&] { return there.zero_since != 0; }));
    best = std::min(best, seconds(Duration(there.zero_since) - last));
  }
  EXPECT_LE(best, 0.005);
  static_cast<void>(driver->read(Time(net::steady_now())));
  EXPECT_THAT(driver->remarks(), Contains(HasSubstr("the loop was silent for 3 ms")));
  EXPECT_TRUE(driver->linked());
}

TEST(Phantom, TheSwitchOnTheStylusIsADeadMansSwitch) {
  PhantomBench there;
  const auto driver = there.open();
  ASSERT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().norm() > 0.0; }));
  there.with([&] { there.server.press(false); });
  EXPECT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().norm() == 0.0; }));
  EXPECT_TRUE(there.push_until(*driver, kPush, [&] { return there.sample.health == Health::fault; }));
  EXPECT_TRUE(driver->linked());
  there.with([&] { there.server.press(true); });
  EXPECT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().norm() > 0.0; }));
  EXPECT_TRUE(there.push_until(*driver, kPush, [&] { return there.sample.health == Health::ok; }));
  EXPECT_THAT(driver->remarks(), Contains(HasSubstr("the dead man's switch was open")));
}

TEST(Phantom, WarmMotorsAndTooMuchForceAreFaultsThatPass) {
  PhantomBench there;
  const auto driver = there.open();
  for (const double error : {512.0, 513.0}) {  // HD_WARM_MOTORS, HD_EXCEEDED_MAX_FORCE
    ASSERT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().norm() > 0.0; }));
    there.with([&] { there.server.suffer({Trouble::Kind::error_code, error}); });
    EXPECT_TRUE(there.push_until(
        *driver, kPush, [&] { return there.force().norm() == 0.0 && there.sample.health == Health::fault; }));
    there.with([&] { there.server.heal(Trouble::Kind::error_code); });
    EXPECT_TRUE(driver->linked());
    EXPECT_TRUE(there.push_until(*driver, kPush, [&] { return there.sample.health == Health::ok; }));
  }
  there.with([&] { there.server.warm(0.97); });
  EXPECT_TRUE(there.push_until(
      *driver, kPush, [&] { return there.force().norm() == 0.0 && there.sample.health == Health::fault; }));
  EXPECT_THAT(driver->remarks(), AllOf(Contains(HasSubstr("HD_EXCEEDED_MAX_FORCE (0x0201)")),
                                       Contains(HasSubstr("warmest motor 97 %"))));
}

// An old device has no model of its motors' temperature: HD_INVALID_ENUM in each frame would be a fault for
// ever.
TEST(Phantom, ADeviceThatReportsNoTemperatureExertsItsForce) {
  PhantomBench there;
  there.with([&] { there.server.warm(kUnset); });
  const auto driver = there.open();
  EXPECT_THAT(driver->describe(), HasSubstr("does not report motor temperatures"));
  EXPECT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().xyz == kPush.xyz; }));
  EXPECT_EQ(driver->read(Time(net::steady_now())).health, Health::ok);
}

TEST(Phantom, ABrokenConnectionEndsTheLink) {
  PhantomBench there;
  const auto driver = there.open();
  ASSERT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().norm() > 0.0; }));
  there.with([&] { there.server.suffer({Trouble::Kind::error_code, 0x0302}); });
  EXPECT_TRUE(
      there.push_until(*driver, kPush, [&] { return !driver->linked() && there.force().norm() == 0.0; }));
  EXPECT_EQ(driver->read(Time(net::steady_now())).health, Health::fault);
  there.with([&] { there.server.heal(Trouble::Kind::error_code); });
  static_cast<void>(there.push_until(*driver, kPush, [i = 0]() mutable { return ++i > 100; }));
  EXPECT_EQ(there.force().norm(), 0.0) << "until a new run";
  EXPECT_THAT(there.log.lines(), Contains(HasSubstr("arm lost: HD_COMM_ERROR (0x0302)")));
}

// The scheduler makes no more calls: the watch switches the motors off from its own thread.
TEST(Phantom, ACallbackThatNeverComesMeansNoForceWithinFiveMilliseconds) {
  double best = 1.0;  // s
  for (int i = 0; i < 20 && best > 0.005; ++i) {
    PhantomBench there;
    there.table.silent = 0.004;
    const auto driver = there.open();
    if (!there.push_until(*driver, kPush, [&] { return there.zero_since == 0 || !driver->linked(); }))
      continue;
    there.publishes = false;
    const Duration last = net::steady_now();
    ASSERT_TRUE(there.until([&] { return there.zero_since != 0; }));
    ASSERT_TRUE(there.until([&] { return !driver->linked(); }));
    EXPECT_FALSE(there.motors_on());
    EXPECT_EQ(driver->read(Time(net::steady_now())).health, Health::fault);
    best = std::min(best, seconds(Duration(there.zero_since) - last));
    there.publishes = true;  // the calls come back: still no force
    static_cast<void>(there.push_until(*driver, kPush, [k = 0]() mutable { return ++k > 20; }));
    EXPECT_EQ(there.force().norm(), 0.0);
    EXPECT_THAT(there.log.lines(), Contains(HasSubstr("its own thread came too late, or never again")));
  }
  EXPECT_LE(best, 0.005);
}

// A scheduler that hangs: the driver is gone within its patience, and the callback that returns does no harm.
TEST(Phantom, ADriverEndsAlthoughItsSchedulerHangs) {
  PhantomBench there;
  there.table.silent = 0.05;
  auto driver = there.open();
  there.publishes = false;
  ASSERT_TRUE(there.until([&] { return !driver->linked(); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const Duration begun = net::steady_now();
  driver.reset();
  EXPECT_LT(seconds(net::steady_now() - begun), 1.0);
  there.publishes = true;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  // The end of the process would close the device; other tests of this process need it.
  const phantom::hd::Functions hd(
      arm::Library({{"libHD.so"}, arm::kFakeLibrary, "driver.phantom.library", "the fake"}));
  hd.disable_device(1);
}

TEST(Phantom, ACallbackThatThrowsMeansNoForce) {
  PhantomBench there;
  auto driver = there.open();
  ASSERT_TRUE(there.push_until(*driver, kPush, [&] { return there.force().norm() > 0.0; }));
  there.with([&] { there.server.flag(arm::kThrows, true); });
  EXPECT_TRUE(there.until([&] { return there.force().norm() == 0.0 && !there.motors_on(); }));
  EXPECT_TRUE(there.until([&] { return !driver->linked(); }));
  EXPECT_THAT(there.log.lines(), Contains(HasSubstr("the vendor's library threw an exception")));
  // No call hangs in the library, so the driver gives the device back, however late.
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  driver.reset();
  there.with([&] { there.server.flag(arm::kThrows, false); });
  EXPECT_TRUE(there.open()->linked());
}

TEST(Phantom, AnArmThatIsNotCalibratedIsRefusedWithTheWayOut) {
  PhantomBench there;
  there.with([&] { there.server.flag(arm::kUncalibrated, true); });
  EXPECT_THAT(refusal(ErrorKind::device, [&] { static_cast<void>(there.open()); }),
              AllOf(HasSubstr("it is not calibrated; hold the arm in its reset position"),
                    HasSubstr("calibration=update")));
  there.table.calibration = "update";
  EXPECT_EQ(there.open()->read(Time(net::steady_now())).health, Health::ok);
}

TEST(Phantom, AnotherArmThanTheRigsIsRefused) {
  PhantomBench there;
  there.defaults.rig.arm.machine.phantom.l1 = 0.215;  // a Premium 1.5
  EXPECT_THAT(refusal(ErrorKind::device, [&] { static_cast<void>(there.open()); }),
              HasSubstr("mm from where [arm.machine] has it at its joints"));
}

TEST(Phantom, ADeviceThatDoesNotAnswerIsSaid) {
  PhantomBench there;
  there.table.device = "127.0.0.1:9";
  EXPECT_THAT(refusal(ErrorKind::device, [&] { static_cast<void>(there.open()); }),
              AllOf(HasSubstr("127.0.0.1:9 of "), HasSubstr("it does not open: HD_COMM_ERROR (0x0302)")));
}

// ---- in lockstep: the arm of the twin behind the fake library is the arm of the twin, to the bit

// The rig's clock; each state is in the socket before the driver reads.
class PublishingClock final : public Clock {
 public:
  PublishingClock(std::unique_ptr<Clock> clock, std::function<void(Time)> publish)
      : clock_(std::move(clock)), publish_(std::move(publish)) {}
  Tick next() override {
    const Tick tick = clock_->next();
    publish_(tick.t);
    return tick;
  }

 private:
  std::unique_ptr<Clock> clock_;
  std::function<void(Time)> publish_;
};

// The twin's arm behind the fake library, in the twin's time.
struct WiredTwin {
  explicit WiredTwin(const std::vector<std::string>& set) {
    trial::TrialOptions options;
    options.seconds = 12.0;
    options.fit_out = [this](Rig& rig) { fit_out(rig); };
    models::Setup setup = models::load(scene_file("wall"), "vishap", set);
    spec = setup.rig;
    trial = std::make_unique<trial::Trial>(std::move(setup), std::move(options));
  }
  ~WiredTwin() {
    trial.reset();
    thread.request_stop();
  }
  WiredTwin(const WiredTwin&) = delete;
  WiredTwin& operator=(const WiredTwin&) = delete;
  void fit_out(Rig& rig) {
    arm = std::move(rig.arm);
    const Arm machine(arm->ability().machine);
    server =
        std::make_unique<arm::ArmServer>(*arm,
                                         arm::ArmServerSettings{.place = {"127.0.0.1", 0},
                                                                .home = machine.tip({}).xyz,
                                                                .advance = [this] { server->publish(now); }},
                                         log);
    rig.clock = std::make_unique<PublishingClock>(std::move(rig.clock), [this](Time t) {
      const std::lock_guard lock(mutex);
      now = t;
      server->publish(t);
    });
    thread = std::jthread([this](const std::stop_token& end) { serve(end); });
    PhantomBench::Table table;
    table.device = "127.0.0.1:" + std::to_string(server->port());
    DefaultOffer defaults;
    rig.arm = phantom::opened({table, spec, defaults.reach, Duration(1'000'000), log, true, true});
  }
  void serve(const std::stop_token& end) {
    while (!end.stop_requested()) {
      {
        const std::lock_guard lock(mutex);
        server->serve(now);
      }
      std::this_thread::yield();
    }
  }
  RigSpec spec;
  trial::DeviceLog log;
  std::unique_ptr<HapticArm> arm;
  std::unique_ptr<arm::ArmServer> server;
  std::mutex mutex;
  Time now{};
  std::jthread thread;
  std::unique_ptr<trial::Trial> trial;
};

// One press with its approach. The hash covers the core's whole state in each tick: what the driver reads and
// what the arm exerts differ by no bit.
TEST(Phantom, InLockstepARunOverTheFakeLibraryIsTheTwins) {
  const std::vector<std::string> set{"user.depth_mm=5", "user.press_s=0.5", "user.hold_s=0",
                                     "user.release_s=0.5", "user.rest_s=6"};
  WiredTwin wired(set);
  const trial::TrialResult over = wired.trial->run();
  EXPECT_GT(wired.server->forces(), 11'000);
  trial::TrialOptions options;
  options.seconds = 12.0;
  const trial::TrialResult pure =
      trial::Trial(models::load(scene_file("wall"), "vishap", set), options).run();
  EXPECT_EQ(over.contacts, 1);
  EXPECT_EQ(over.hash, pure.hash);
}

}  // namespace
}  // namespace enc::test
