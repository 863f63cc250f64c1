// The exchange between the loop and a force-controlled arm's own thread, beside a watch and a fault.
#include "hw_drivers/arm/servo.h"

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "core/devices/driver.h"
#include "hw_drivers/net/clocks.h"

namespace enc::arm {
namespace {

struct NoLog final : Log {
  void say(const std::string&) override { ++lines; }
  std::atomic<int> lines = 0;
};

bool whole(const std::array<double, 3>& numbers) {
  return numbers[0] == numbers[1] && numbers[1] == numbers[2];
}

ArmReading reading_of(double number) {
  ArmReading reading;
  reading.at = net::steady_now();
  reading.sample.joints = {number, number, number};
  reading.sample.tip = Point<'R'>(number, number, number);
  return reading;
}

// Neither side sees half of the other's numbers, and after a fault no force passes.
TEST(ArmServo, LoopAndDeviceExchangeWholeNumbersUntilItIsLost) {
  NoLog log;
  std::atomic<int> cuts = 0;
  ServoSettings settings;
  settings.guard.rise = 0.0;
  settings.guard.most = 1e9;
  settings.guard.watchdog = settings.silent = 10.0;  // s: a busy machine
  Servo servo(
      settings, log, [&] { ++cuts; }, [](int) { return std::string(); });
  std::atomic<bool> end = false;
  std::atomic<std::int64_t> torn = 0, forces = 0, after = 0;
  std::thread device([&] {
    for (double n = 1.0; !end; n += 1.0) {
      const bool lost = !servo.linked();
      const Vec<'R'> force = servo.turn(reading_of(n));
      torn += whole(force.xyz) ? 0 : 1;
      forces += force.xyz[0] > 0.0 ? 1 : 0;
      after += lost && force.norm() > 0.0 ? 1 : 0;
    }
  });
  ASSERT_TRUE(servo.comes(10.0));
  double last = 0.0;
  std::int64_t older = 0;
  for (int i = 1; i < 20'000 || forces < 100; ++i) {
    const auto sample = servo.read(Time(net::steady_now()));
    torn += whole(sample.value.joints) && whole(sample.value.tip.xyz) ? 0 : 1;
    older += sample.value.joints[0] < last ? 1 : 0;
    last = sample.value.joints[0];
    servo.command(Vec<'R'>(i, i, i));
  }
  std::thread breaker([&] { servo.lose("a test"); });
  servo.lose("the same test");
  breaker.join();
  for (int i = 0; i < 1000; ++i) servo.command(Vec<'R'>(1, 1, 1));
  end = true;
  device.join();
  EXPECT_EQ(servo.read(Time(net::steady_now())).health, Health::fault);
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(older, 0);
  EXPECT_EQ(after, 0);
  EXPECT_EQ(cuts, 1);
  EXPECT_EQ(log.lines, 1);
  EXPECT_GT(forces, 0);
}

}  // namespace
}  // namespace enc::arm
