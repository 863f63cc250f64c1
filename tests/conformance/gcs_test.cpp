// The driver of the C-887 beyond the contract of every manipulator: lost links, and every end of a run.
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "sim/plants/hexapod_plant.h"
#include "tests/conformance/gcs_bench.h"
#include "tests/support/built.h"
#include "tests/support/error_of.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

std::string refused(GcsBench& bench) {
  return error_of([&] { bench.driver(); }, ErrorKind::device);
}
void wait(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }
// Waits until a condition holds, at most 3 s.
template <class What>
bool comes(const What& what) {
  for (int i = 0; i < 3000 && !what(); ++i) wait(1);
  return what();
}
Pose<'R', 'H'> beside(const Manipulator& machine, double x) {
  return Pose<'R', 'H'>::shift(x, 0, machine.reach().machine.zero().p().z());
}

TEST(GcsDriver, SaysWhatItFound) {
  GcsBench bench;
  const auto driver = bench.driver();
  EXPECT_EQ(driver->describe(), "C-887.53 119000000 at 127.0.0.1:50000, firmware 2.10.0.1, referenced");
  EXPECT_TRUE(driver->linked());
  EXPECT_EQ(driver->reach().speed, 0.05);
  EXPECT_THAT(driver->remarks(), ElementsAre(HasSubstr(" positions, the longest answer took ")));
  GcsBench faster;
  faster.settings.velocity = 0.08;
  EXPECT_EQ(faster.driver()->reach().speed, 0.08);
}

TEST(GcsDriver, WhoDoesNotAnswerIsOneLine) {
  GcsBench fresh({.referenced = false});
  EXPECT_THAT(refused(fresh), HasSubstr("is not referenced"));
  GcsBench silent;
  silent.silent = true;
  EXPECT_EQ(refused(silent),
            "127.0.0.1:50000: no answer to *IDN? within 1000 ms; see that it is a C-887, and ready");
  GcsBench gone;
  gone.hung_up = true;
  EXPECT_EQ(refused(gone),
            "127.0.0.1:50000: closed the connection; close other clients (PIMikroMove) and try again");
}

// Every end during a motion brings the machine to rest on its path: stop(), the end of the driver, a loop
// that falls silent.
TEST(GcsDriver, EveryEndLeavesTheMachineAtRest) {
  for (const int end : {0, 1, 2}) {
    GcsBench bench;
    auto driver = bench.driver();
    const auto way = beside(*driver, 0.03);
    EXPECT_TRUE(comes([&] {
      tell(*driver, way);
      const auto seen = bench.seen();  // on a busy machine the watchdog stops it between two polls
      return seen.x > 0.005 && !seen.at_rest;
    })) << end;
    if (end == 0) driver->stop();
    if (end == 1) {
      driver.reset();
      bench.pass(bench.time + Duration(80'000'000));  // braking at 1.64 m/s2 takes 31 ms
    }
    wait(50);  // on a busy machine it rests between two commands, and the last is still unread
    EXPECT_TRUE(comes([&] { return bench.seen().at_rest; })) << end;
    const double stood = bench.seen().x;
    wait(50);
    EXPECT_EQ(bench.seen().x, stood) << end;
    EXPECT_LT(stood, 0.028) << end;
    EXPECT_GT(stood, 0.002) << end;
    if (end == 2) {
      EXPECT_THAT(driver->remarks(), Contains(HasSubstr(" times: the loop was silent")));
    }
  }
}

TEST(GcsDriver, WithoutACommandNothingIsTold) {
  GcsBench bench;
  {
    const auto driver = bench.driver();
    wait(50);
    EXPECT_EQ(driver->read(Time{}).health, Health::ok);
  }
  EXPECT_TRUE(bench.controller.at_rest());
  EXPECT_EQ(bench.controller.error(), 0);  // no #24 either
}

TEST(GcsDriver, ALostLinkIsSaidAndStaysLost) {
  for (const bool silent : {false, true}) {
    GcsBench bench;
    {
      const auto driver = bench.driver();
      tell(*driver, beside(*driver, 0.001));
      (silent ? bench.silent : bench.hung_up) = true;
      EXPECT_TRUE(comes([&] { return !driver->linked(); })) << silent;
      EXPECT_EQ(driver->read(Time{}).health, Health::fault);
      tell(*driver, beside(*driver, 0.002));
      driver->stop();  // does not wait
      bench.silent = bench.hung_up = false;
      wait(20);
      EXPECT_FALSE(driver->linked());
    }
    EXPECT_THAT(bench.log.lines(), ElementsAre(HasSubstr(silent ? "lost: no answer in time"
                                                                : "lost: closed by the controller")));
    if (silent) {
      // The driver sent a stop, in case the controller still listens.
      EXPECT_EQ(bench.controller.error(), 10);
    }
  }
}

// The first ERR? clears earlier errors: error 10 is the end of every run, and the log omits it.
TEST(GcsDriver, AnErrorOfBeforeIsSaidAsSuch) {
  for (const auto& [told, lines] : {std::pair{"", 0U}, {"\x18", 0U}, {"STP\n", 0U}, {"WHAT\n", 1U}}) {
    SCOPED_TRACE(told);
    GcsBench bench;
    EXPECT_EQ(bench.controller.take(told), "");
    EXPECT_EQ(bench.driver()->read(Time{}).health, Health::ok);
    ASSERT_EQ(bench.log.lines().size(), lines);
    EXPECT_THAT(bench.log.lines(),
                testing::Each(HasSubstr(": an error of before this run: error 2: unknown command")));
  }
}

TEST(GcsDriver, AWatchdogOfLessThanThreeCyclesIsRefused) {
  GcsBench bench;
  bench.settings.watchdog = 0.0029;
  EXPECT_THAT(error_of([&] { static_cast<void>(bench.driver()); }),
              HasSubstr("watchdog_ms is 2.9, and the loop's cycle takes 1 ms"));
  bench.settings.watchdog = 0.003;
  EXPECT_TRUE(bench.driver()->linked());
}

TEST(GcsDriver, APositionThatIsLostBeforeTheNextIsRefused) {
  GcsBench bench;
  bench.settings.poll = 0.0051;
  EXPECT_THAT(error_of([&] { static_cast<void>(bench.driver()); }),
              HasSubstr("stale_ms of [force] is 5, and poll_ms is 5.1"));
  bench.settings.poll = 0.005;
  EXPECT_TRUE(bench.driver()->linked());
}

TEST(GcsDriver, AFailureOfTheMachineIsAFaultAndALine) {
  GcsBench bench;
  const auto driver = bench.driver();
  bench.failure = 504;
  EXPECT_TRUE(comes([&] { return driver->read(Time{}).health == Health::fault; }));
  EXPECT_TRUE(comes([&] { return !driver->linked(); }));
  EXPECT_TRUE(comes([&] { return bench.log.lines().size() == 2; }));
  for (int i = 0; i < 50; ++i) {
    tell(*driver, beside(*driver, 0.001));
    wait(1);
  }
  EXPECT_EQ(driver->read(Time{}).health, Health::fault);  // stays so in this run
  EXPECT_THAT(bench.log.lines(), ElementsAre(HasSubstr("met error 504: a strut does not follow"),
                                             HasSubstr("lost: a fault of the machine")));
}

// ---- over loopback

TEST(GcsPort, ASecondClientIsRefusedAndTheFirstGoesOn) {
  GcsPort there;
  const auto first = gcs::connected(there.offer());
  EXPECT_EQ(first->describe(), "C-887.53 119000000 at 127.0.0.1:" + std::to_string(there.server.port()) +
                                   ", firmware 2.10.0.1, referenced");
  EXPECT_THAT(error_of([&] { static_cast<void>(gcs::connected(there.offer())); }),
              HasSubstr("closed the connection; close other clients"));
  EXPECT_THAT(there.log.lines(), ElementsAre("fake C-887: a second client was refused"));
  EXPECT_TRUE(comes([&] {
    tell(*first, beside(*first, 0.001));  // repeated: a busy machine may discard a late one
    return first->read(Time{}).value.X_RH.p().x() > 1e-6;
  }));
  EXPECT_TRUE(first->linked());
}

// A server on this PC may relay everything to a real machine: without a calibration the driver commands only
// a fake that identifies itself as one.
TEST(GcsPort, ARelayOnThisPcIsARealMachine) {
  for (const bool fake : {true, false}) {
    gcs::ControllerSettings settings;
    if (!fake)
      settings.identity = "(c)2019 Physik Instrumente (PI) GmbH & Co. KG, C-887.53, 119000000, 2.10.0.1";
    GcsPort there(settings);
    const tests::Result r = tests::run_program(
        {"run", tests::shipped_scene("plane"), "--armed", "--yes", "--not-real-time", "--for-s", "0.1",
         "--set", "rig.manipulator.driver=gcs", "rig.driver.gcs.address=\"127.0.0.1\"",
         "rig.driver.gcs.port=" + std::to_string(there.server.port())},
        {{"ENCOUNTER_MODULES", tests::module_folder()}});
    EXPECT_TRUE(comes([&] { return !there.log.lines().empty(); }));
    if (fake) {
      EXPECT_THAT(r.out, HasSubstr(", referenced (a fake)\n")) << r.err;
      continue;
    }
    EXPECT_EQ(r.code, 2) << r.out;
    EXPECT_THAT(r.err, HasSubstr("this rig has no day of calibration"));
    EXPECT_THAT(there.log.lines(), ElementsAre(HasSubstr("it commanded 0 moves and 0 stops")));
  }
}

TEST(GcsPort, TheNextClientFindsItAsItIs) {
  GcsPort there;
  for (const double x : {0.001, 0.002}) {
    const auto driver = gcs::connected(there.offer());
    EXPECT_NEAR(driver->read(Time{}).value.X_RH.p().x(), x - 0.001, 3e-6);
    for (int i = 0; i < 400; ++i) {
      tell(*driver, beside(*driver, x));
      wait(1);
    }
  }
}

TEST(GcsPort, AControllerThatGoesAwayIsALostLink) {
  auto there = std::make_unique<GcsPort>();
  Offer offer = there->offer();
  trial::DeviceLog log;
  const auto driver = gcs::connected({offer.table, offer.rig, offer.reach, offer.period, log});
  EXPECT_TRUE(driver->linked());
  there.reset();
  EXPECT_TRUE(comes([&] { return !driver->linked(); }));
  EXPECT_TRUE(comes([&] { return !log.lines().empty(); }));
  EXPECT_THAT(log.lines(), ElementsAre(HasSubstr("lost: closed by the controller")));
  driver->stop();
}

TEST(GcsPort, AnErrorOfTheFakeWithoutACodeIsThatOfAStrut) {
  FollowingMachine machine;
  trial::DeviceLog log;
  gcs::Server server(machine, {}, "127.0.0.1", 0, log);
  for (const double none : {0.0, 4294967295.0})
    EXPECT_FALSE(server.knows({Trouble::Kind::error_code, none})) << none;
  for (const auto& [code, said] : {std::pair{kUnset, "504\n"}, {1024.0, "1024\n"}}) {
    ASSERT_TRUE(server.knows({Trouble::Kind::error_code, code}));
    server.suffer({Trouble::Kind::error_code, code});
    net::Socket client = net::connect_tcp("127.0.0.1", server.port(), Duration(1'000'000'000));
    const std::string question = "ERR?\n";
    EXPECT_EQ(client.send(std::as_bytes(std::span(question))), question.size());
    std::array<std::byte, 16> bytes{};
    std::size_t got = 0;
    EXPECT_TRUE(comes([&] {
      server.serve(Time{});
      if (got == 0) got = client.receive(bytes);
      return got > 0;
    }));
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), got), said);
    client = {};
    EXPECT_TRUE(comes([&] {  // one client at a time
      server.serve(Time{});
      return !log.lines().empty();
    }));
  }
}

// The fake's world begins anew with the client: delays count in that world's time.
TEST(GcsPort, AFaultOfTheLineIsTheSameHoweverLateTheClientCame) {
  for (const std::int64_t waited_s : {0, 10}) {
    FollowingMachine machine;
    trial::DeviceLog log;
    gcs::Server server(machine, {}, "127.0.0.1", 0, log, [] {});
    server.suffer({Trouble::Kind::slow_start, 0.1});
    net::Socket client = net::connect_tcp("127.0.0.1", server.port(), Duration(1'000'000'000));
    const std::string question = "ERR?\n";
    ASSERT_EQ(client.send(std::as_bytes(std::span(question))), question.size());
    server.serve(Time{Duration(waited_s * 1'000'000'000)});
    std::array<std::byte, 16> bytes{};
    int ms = 0;
    for (std::size_t got = 0; got == 0 && ms < 1000; got = client.receive(bytes))
      server.serve(Time{Duration(++ms * 1'000'000LL)});
    EXPECT_GE(ms, 100) << waited_s;
    EXPECT_LT(ms, 1000) << waited_s;
  }
}

TEST(GcsPort, NobodyThereIsOneLine) {
  GcsPort there;
  there.table.port = 1;
  EXPECT_THAT(error_of([&] { static_cast<void>(gcs::connected(there.offer())); }, ErrorKind::device),
              HasSubstr("127.0.0.1:1: nobody listens there"));
}

// The driver's model of the machine under its set-points equals the twin's machine, to the bit: lag, delay,
// limits and steps.
TEST(GcsDriver, TheBelievedServoIsTheTwins) {
  const RigSpec rig;
  const sim::HexapodTruth truth;
  sim::HexapodPlant plant(truth, 1);
  const Vec3 zero = plant.machine().zero().p();
  const ServoLaw law{rig.manipulator.servo, rig.manipulator.servo_damping, rig.manipulator.speed,
                     rig.manipulator.acceleration};
  gcs::BelievedServo servo(law, rig.manipulator.delay, 1e-3, truth.step, zero);
  servo.stand(zero);
  double most = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double t = 1e-3 * i;
    const Vec3 p = zero + Vec3(0.01 * std::sin(5 * t), 0.004 * std::sin(17 * t), i > 1500 ? 0.005 : 0.0);
    plant.command(Pose<'R', 'H'>(plant.machine().zero().q(), p));
    plant.begin_cycle();
    plant.move(1e-3);
    servo.next(p);
    ASSERT_EQ(servo.motion().p, plant.state().pose.p()) << i;
    ASSERT_EQ(servo.motion().acceleration, plant.state().acceleration.e()) << i;
    most = std::max(most, servo.motion().acceleration.norm());
  }
  EXPECT_NEAR(most, 0.41, 1e-6);  // the leap
  servo.stand(zero);
  EXPECT_EQ(servo.motion().acceleration.norm(), 0.0);
}

}  // namespace
}  // namespace enc::test
