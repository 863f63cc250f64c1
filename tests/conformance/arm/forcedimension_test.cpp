// The driver of a Force Dimension device against the fake libdhd.so: the same role, the same guard.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/arm/delta_bench.h"
#include "tests/support/refusal.h"

namespace enc::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

const Vec<'R'> kDeltaPush(0.5, -1.5, 2.5);

TEST(ForceDimension, SaysWhatItIsAndWhereItsTipIs) {
  DeltaBench there;
  const auto driver = there.open();
  EXPECT_TRUE(driver->is_fake());
  EXPECT_EQ(driver->describe(), "Encounter fake omega.3, serial 1, DHD 3.17.6, calibrated");
  const auto sample = driver->read(Time(net::steady_now()));
  EXPECT_EQ(sample.health, Health::ok);
  EXPECT_LT((sample.value.tip - Point<'R'>(0.01, -0.02, 0.03)).norm(), 1e-12);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(sample.value.joints[i], there.arm.joints[i], 1e-9);
    EXPECT_NEAR(sample.value.joint_velocities[i], sample.value.velocity.xyz[i], 1e-9);
  }
  EXPECT_FALSE(there.motors_on());
}

TEST(ForceDimension, ExertsTheForceThatItIsGivenAndStops) {
  DeltaBench there;
  auto driver = there.open();
  ASSERT_TRUE(there.push_until(*driver, kDeltaPush, [&] { return there.force().xyz == kDeltaPush.xyz; }));
  EXPECT_TRUE(there.motors_on());
  driver->stop();
  EXPECT_TRUE(DeltaBench::until([&] { return there.force().norm() == 0.0 && !there.motors_on(); }));
  ASSERT_TRUE(there.push_until(*driver, kDeltaPush, [&] { return there.force().xyz == kDeltaPush.xyz; }));
  driver.reset();
  EXPECT_TRUE(DeltaBench::until([&] { return there.force().norm() == 0.0; }));
}

TEST(ForceDimension, ASilentLoopMeansNoForceWithinFiveMilliseconds) {
  DeltaBench there;
  there.table.watchdog_periods = 3;
  const auto driver = there.open();
  double best = 1.0;  // s
  for (int i = 0; i < 20 && best > 0.005; ++i) {
    ASSERT_TRUE(there.push_until(*driver, kDeltaPush, [&] { return there.zero_since == 0; }));
    const Duration last = net::steady_now();
    ASSERT_TRUE(DeltaBench::until([&] { return there.zero_since != 0; }));
    best = std::min(best, seconds(Duration(there.zero_since) - last));
  }
  EXPECT_LE(best, 0.005);
  EXPECT_TRUE(driver->linked());
}

// The firmware's watchdog is set, and ends the force of a program that is gone: here its thread has no states
// to go on with, as after SIGKILL, and the driver's own watch is too patient.
TEST(ForceDimension, TheFirmwaresWatchdogEndsTheForceOfAProgramThatIsGone) {
  DeltaBench there;
  const auto driver = there.open();
  ASSERT_TRUE(there.push_until(*driver, kDeltaPush, [&] { return there.force().norm() > 0.0; }));
  EXPECT_NEAR(there.with([&] { return there.server.watchdog(); }), 0.031, 1e-9);
  const Duration last = net::steady_now();
  there.with([&] { there.server.suffer({Trouble::Kind::stall, 0.0}); });  // neither states nor forces
  ASSERT_TRUE(DeltaBench::until([&] { return there.force().norm() == 0.0; }));
  EXPECT_LT(seconds(net::steady_now() - last), 1.0);
  there.with([&] { there.server.heal(Trouble::Kind::stall); });
}

TEST(ForceDimension, TheSwitchIsADeadMansSwitch) {
  DeltaBench there;
  const auto driver = there.open();
  ASSERT_TRUE(there.push_until(*driver, kDeltaPush, [&] { return there.force().norm() > 0.0; }));
  there.with([&] { there.server.press(false); });
  EXPECT_TRUE(there.push_until(*driver, kDeltaPush, [&] {
    return there.force().norm() == 0.0 && there.sample.health == Health::fault;
  }));
  there.with([&] { there.server.press(true); });
  EXPECT_TRUE(there.push_until(*driver, kDeltaPush, [&] { return there.force().norm() > 0.0; }));
}

TEST(ForceDimension, AnErrorOrAThrowEndsTheLink) {
  for (const bool throws : {false, true}) {
    DeltaBench there;
    const auto driver = there.open();
    ASSERT_TRUE(there.push_until(*driver, kDeltaPush, [&] { return there.force().norm() > 0.0; }));
    there.with([&] {
      throws ? there.server.flag(arm::kThrows, true)
             : there.server.suffer({Trouble::Kind::error_code, kUnset});
    });
    EXPECT_TRUE(there.push_until(*driver, kDeltaPush,
                                 [&] { return !driver->linked() && there.force().norm() == 0.0; }));
    EXPECT_THAT(there.log.lines(), Contains(HasSubstr(throws ? "threw an exception" : "DHD error 2")));
  }
}

TEST(ForceDimension, AThreadThatNeverComesMeansNoForceWithinFiveMilliseconds) {
  double best = 1.0;  // s
  for (int i = 0; i < 20 && best > 0.005; ++i) {
    DeltaBench there;
    there.table.silent = 0.004;
    const auto driver = there.open();
    if (!there.push_until(*driver, kDeltaPush, [&] { return there.zero_since == 0 || !driver->linked(); }))
      continue;
    there.publishes = false;
    const Duration last = net::steady_now();
    ASSERT_TRUE(DeltaBench::until([&] { return there.zero_since != 0; }));
    ASSERT_TRUE(DeltaBench::until([&] { return !driver->linked(); }));
    best = std::min(best, seconds(Duration(there.zero_since) - last));
  }
  EXPECT_LE(best, 0.005);
}

TEST(ForceDimension, AnArmThatIsNotCalibratedOrNotThereIsRefused) {
  DeltaBench there;
  there.with([&] { there.server.flag(arm::kUncalibrated, true); });
  EXPECT_THAT(refusal(ErrorKind::device, [&] { static_cast<void>(there.open()); }),
              HasSubstr("it is not calibrated; calibrate it with the vendor's tool"));
  there.table.serial = 9;
  EXPECT_THAT(refusal(ErrorKind::device, [&] { static_cast<void>(there.open()); }),
              HasSubstr("it does not open: DHD error 5: no device"));
  there.table.library = "libm.so.6";
  EXPECT_THAT(refusal(ErrorKind::device, [&] { static_cast<void>(there.open()); }),
              HasSubstr("libm.so.6 lacks dhdOpen"));
}

}  // namespace
}  // namespace enc::test
