// Readings of a force-controlled arm, as HD and DHD give them: numbers of a library, which are not parsed.
#include <cmath>
#include <cstring>
#include <string>

#include "hw_drivers/arm/servo.h"
#include "hw_drivers/net/clocks.h"
#include "tests/fuzz/machine/fuzzing.h"

namespace enc::fuzz {
namespace {

struct ReadingBytes {
  double joints[3], tip[3], velocity[3], warmth, later, force[3];  // `later`: s since the reading before
  std::int32_t error, pressed;
};

arm::ArmReading reading_of(const ReadingBytes& one, Duration at) {
  arm::ArmReading reading;
  for (std::size_t i = 0; i < 3; ++i) reading.sample.joints[i] = one.joints[i];
  reading.sample.tip = Point<'R'>(one.tip[0], one.tip[1], one.tip[2]);
  reading.sample.velocity = Vec<'R'>(one.velocity[0], one.velocity[1], one.velocity[2]);
  reading.at = at;
  reading.pressed = one.pressed != 0;
  reading.error = one.error;
  reading.warmth = one.warmth;
  return reading;
}

struct SilentLog final : Log {
  void say(const std::string&) override {}
};

// Whatever the readings are, the force is a number within the device's limit.
Target readings() {
  Target target;
  const auto bytes = [](const ReadingBytes& one) {
    return std::string(reinterpret_cast<const char*>(&one), sizeof(one));
  };
  const ReadingBytes calm{{0.1, 0.2, 0.3}, {0.0, 0.1, 0.0}, {}, 0.2, 0.001, {1, 2, 3}, 0, 1};
  ReadingBytes faulty = calm;
  faulty.error = 0x302;
  faulty.warmth = 1.5;
  target.seeds = {bytes(calm) + bytes(calm) + bytes(calm) + bytes(calm), bytes(calm) + bytes(faulty)};
  target.tokens = {std::string("\0\0\0\0\0\0\xf8\x7f", 8), std::string("\0\0\0\0\0\0\xf0\xff", 8),
                   std::string("\xff\xff\xff\xff\xff\xff\xef\x7f", 8)};
  target.run = [](const std::string& input) {
    arm::ServoSettings settings;
    settings.watched = false;
    SilentLog log;
    arm::Servo servo(
        settings, log, [] {}, [](int) { return std::string("an error"); });
    std::int64_t now = 1;
    bool pushed = false;
    for (std::size_t at = 0; at + sizeof(ReadingBytes) <= input.size(); at += sizeof(ReadingBytes)) {
      ReadingBytes one;
      std::memcpy(&one, input.data() + at, sizeof(one));
      now += one.later > 0.0 && one.later < 100.0 ? static_cast<std::int64_t>(1e9 * one.later) : 1'000'000;
      const arm::ArmReading reading = reading_of(one, Duration(now));
      net::stand_at(Duration(now));
      static_cast<void>(servo.read(Time(Duration(now))));
      servo.command(Vec<'R'>(one.force[0], one.force[1], one.force[2]));
      const Vec<'R'> force = servo.turn(reading);
      expect(force.finite() && force.norm() <= settings.guard.most * (1.0 + 1e-12),
             "a force beyond the limit");
      expect(reading.error == 0 || force.norm() == 0.0, "a force in spite of an error");
      pushed = pushed || force.norm() > 0.0;
    }
    net::stand_at({});
    static_cast<void>(servo.remarks("arm"));
    return pushed;
  };
  return target;
}

const Offer kReadings("arm_readings", &readings);

}  // namespace
}  // namespace enc::fuzz
