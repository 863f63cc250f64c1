#include "hw_drivers/gripper/drive/conversation.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/devices/fake.h"
#include "hw_drivers/gripper/wire/registers.h"
#include "hw_drivers/net/socket.h"

namespace enc::gripper {

std::string words_of(const Report& report, const char* why) {
  switch (report.trap) {
    case Trap::refused:
      return fmt::format("answers with {}; see its outputs, its inputs and its write lock (register {:#x})",
                         exception_words(report.exception), kWriteLock);
    case Trap::not_set:
      return "confirms an output and does not set it; see which other program writes to it";
    case Trap::bus:
      return fmt::format("reaches its terminals no more (register {:#x}): its inputs are old; see its cables",
                         kBusStatus);
    case Trap::stuck:
      return "its sensors do not fit to the command; see the jaws, their sensors, and "
             "driver.gripper.open_input "
             "and grip_input";
    case Trap::fallback:
      return fmt::format(
          "lost: its watchdog has switched the outputs off (register {:#x}); see to it, then "
          "begin a new run",
          kFallback);
    case Trap::lost:
      return fmt::format("lost: {}; see to it, then begin a new run", why);
    default:
      return {};
  }
}

// ---- the inspection of a coupler

namespace {

class Inspector {
 public:
  Inspector(Coupler& coupler, const GripperSettings& settings) : coupler_(coupler), settings_(settings) {}

  [[noreturn]] void refuse(const std::string& words) const {
    throw Error(settings_.place() + ": " + words, {}, ErrorKind::device);
  }
  void expect(Outcome outcome, const char* what) const {
    if (outcome == Outcome::done) return;
    if (outcome == Outcome::lost)
      refuse(fmt::format("{} within {:.0f} ms; see that it is a Modbus TCP coupler, and driver.gripper.port",
                         coupler_.why(), 1e3 * settings_.timeout));
    refuse(fmt::format("asked for {}, it answers with {}; correct driver.gripper.unit or the address", what,
                       exception_words(coupler_.exception())));
  }
  [[nodiscard]] std::uint16_t one(int at, const char* what) const {
    std::array<std::uint16_t, 1> value{};
    expect(coupler_.read_registers(at, value), what);
    return value[0];
  }
  void enough(std::uint16_t there, std::int64_t at, const char* what, const char* keys) const {
    if (at < there) return;
    refuse(
        fmt::format("it has {} digital {}s, and number {} is used; add a terminal, or correct "
                    "driver.gripper.{}",
                    there, what, at, keys));
  }

 private:
  Coupler& coupler_;
  const GripperSettings& settings_;
};

}  // namespace

Inspection inspect(Coupler& coupler, const GripperSettings& settings) {
  const Inspector ask(coupler, settings);
  Inspection found;
  std::array<std::uint16_t, kIdentityWords> words{};
  ask.expect(coupler.read_registers(kIdentity, words), "its identity");
  const std::string straight = identity_of(words, false), swapped = identity_of(words, true);
  found.fake = straight == kFakeName || swapped == kFakeName;
  const bool known = straight.find(settings.product) != std::string::npos;
  found.identity = known ? straight : swapped;
  if (!found.fake && found.identity.find(settings.product) == std::string::npos)
    ask.refuse(
        fmt::format("another device: it says '{}', expected '{}'; correct driver.gripper.address or "
                    "driver.gripper.product",
                    net::printable(found.identity), settings.product));
  found.outputs = ask.one(kOutputBits, "the number of its digital outputs");
  found.inputs = ask.one(kInputBits, "the number of its digital inputs");
  if (settings.open_output == settings.close_output || settings.open_input == settings.grip_input)
    ask.refuse("one terminal is used for both directions; correct driver.gripper.close_output or grip_input");
  ask.enough(found.outputs, std::max(settings.open_output, settings.close_output), "output",
             "open_output or close_output");
  ask.enough(found.inputs, std::max(settings.open_input, settings.grip_input), "input",
             "open_input or grip_input");
  if (ask.one(kBusStatus, "the state of its terminals") != 1)
    ask.refuse(fmt::format(
        "its terminals do not answer it (register {:#x}); see their cables and their power", kBusStatus));
  found.watchdog = ask.one(kWatchdogTime, "the time of its watchdog");
  found.watchdog_type = ask.one(kWatchdogType, "the type of its watchdog");
  return found;
}

// ---- turns

Drive Conversation::wanted() const noexcept {
  if (order_.number == 0) return Drive::none;
  if (order_.number > order_.stopped) return order_.closed ? Drive::close : Drive::open;
  // After a stop moving jaws come to rest, and a grip stays.
  const GripPhase phase = report_.jaws.phase;
  return phase == GripPhase::closing || phase == GripPhase::opening ? Drive::none : set_;
}

bool Conversation::did(Outcome outcome) noexcept {
  if (outcome == Outcome::done) return true;
  report_.trap = outcome == Outcome::lost ? Trap::lost : Trap::refused;
  report_.exception = coupler_.exception();
  return false;
}

bool Conversation::prepare() noexcept {
  const auto ms = static_cast<std::uint16_t>(std::lround(1e3 * settings_.watchdog));
  struct RegisterValue {
    int at;
    std::uint16_t value;
  };
  for (const RegisterValue& one :
       {RegisterValue{kWatchdogTime, ms}, {kWatchdogType, kAnyTelegram}, {kFallbackType, kAllOff}}) {
    std::array<std::uint16_t, 1> value{};
    if (!did(coupler_.read_registers(one.at, value))) return false;
    if (value[0] == one.value) continue;
    if (!did(coupler_.write_register(one.at, one.value)) || !did(coupler_.read_registers(one.at, value)))
      return false;
    if (value[0] != one.value) report_.trap = Trap::not_set;
    if (value[0] != one.value) return false;
  }
  std::array<std::uint16_t, 1> fallen{};
  if (!did(coupler_.read_registers(kFallback, fallen))) return false;
  // Its watchdog ran out after the last program: that is its rest.
  return fallen[0] == 0 || (did(coupler_.write_register(kWatchdogReset, kResetFirst)) &&
                            did(coupler_.write_register(kWatchdogReset, kResetSecond)));
}

bool Conversation::write(Drive which, bool on) noexcept {
  const auto at = static_cast<int>(which == Drive::open ? settings_.open_output : settings_.close_output);
  std::array<std::uint8_t, 1> is{};
  if (!did(coupler_.write_output(at, on)) || !did(coupler_.read_outputs(at, is))) return false;
  if ((is[0] != 0) != on) report_.trap = Trap::not_set;
  return (is[0] != 0) == on;
}

// Both outputs are never on together: the one goes off, both rest, the other goes on.
void Conversation::set_outputs(Duration now) noexcept {
  const Drive to = wanted();
  if (to != set_ || (order_.number > 0 && !prepared_)) {
    if (!prepared_) {
      // An earlier program may have left an output on.
      prepared_ = prepare() && write(Drive::open, false) && write(Drive::close, false);
      off_ = now;
      went_off_ = true;
    }
    if (!prepared_) return;
    if (set_ != Drive::none) {
      if (!write(set_, false)) return;
      off_ = now;
      went_off_ = true;
      set_ = Drive::none;
      jaws_.drive(set_, now);
    }
    if (to != Drive::none && now - off_ >= from_seconds(settings_.rest) && write(to, true)) {
      set_ = to;
      was_on_ = true;
      jaws_.drive(set_, now);
    }
  }
  if (set_ == wanted()) report_.stops = order_.stops;
}

void Conversation::read_inputs() noexcept {
  const auto low = std::min(settings_.open_input, settings_.grip_input);
  const auto high = std::max(settings_.open_input, settings_.grip_input);
  std::array<std::uint8_t, 256> bits{};
  if (!did(coupler_.read_inputs(static_cast<int>(low),
                                std::span(bits).first(static_cast<std::size_t>(high - low + 1)))))
    return;
  sensors_.open = bits[static_cast<std::size_t>(settings_.open_input - low)] != 0;
  sensors_.gripped = bits[static_cast<std::size_t>(settings_.grip_input - low)] != 0;
  report_.read = true;
}

void Conversation::judge(Duration now) noexcept {
  jaws_.take(sensors_, now);
  report_.jaws = jaws_.sample();
  if (report_.trap != Trap::none) return;
  if (!bus_) report_.trap = Trap::bus;
  if (bus_ && jaws_.stuck()) report_.trap = Trap::stuck;
}

void Conversation::look_after() noexcept {
  looks_at_bus_ = !looks_at_bus_;
  std::array<std::uint16_t, 1> value{};
  if (!did(coupler_.read_registers(looks_at_bus_ ? kBusStatus : kFallback, value))) return;
  if (looks_at_bus_) bus_ = value[0] == 1;
  if (looks_at_bus_ && !bus_) report_.trap = Trap::bus;
  if (!looks_at_bus_ && value[0] != 0 && was_on_) report_.trap = Trap::fallback;
}

}  // namespace enc::gripper
