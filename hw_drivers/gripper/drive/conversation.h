// What the driver and a coupler say to each other in turn: outputs that follow the newest order, the inputs,
// and the state of the coupler. It has no thread and no clock.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "core/base/sample.h"
#include "hw_drivers/gripper/drive/coupler.h"
#include "hw_drivers/gripper/drive/jaws.h"

namespace enc::gripper {

// The newest command of the loop. Before the first one nothing is written.
struct Order {
  std::int64_t number = 0;
  bool closed = false;
  std::int64_t stops = 0;
  std::int64_t stopped = 0;  // number of the order that the last stop ended
};

enum class Trap : std::uint8_t { none, refused, not_set, bus, stuck, fallback, lost };

struct Report {
  GripSample jaws;
  Duration asked{}, answered{};  // of the inputs
  Trap trap = Trap::none;
  int exception = 0;       // of `refused`
  std::int64_t stops = 0;  // that were carried out
  bool read = false;       // the inputs were read at least once
};

// A fault in words, with what to do.
[[nodiscard]] std::string words_of(const Report& report, const char* why);

// What the coupler says of itself before a run.
struct Inspection {
  std::string identity;
  std::uint16_t outputs = 0, inputs = 0, watchdog = 0, watchdog_type = 0;
  bool fake = false;
};
// Only reads. Throws Error (kind device): another device, too few terminals, terminals that do not answer.
[[nodiscard]] Inspection inspect(Coupler& coupler, const GripperSettings& settings);

class Conversation {
 public:
  Conversation(Coupler& coupler, const GripperSettings& settings)
      : coupler_(coupler), settings_(settings), jaws_(settings) {}
  void take(const Order& order) noexcept { order_ = order; }
  // One turn. `now`: a steady clock. False: the link is lost.
  template <class Clock>
  bool turn(Clock now) noexcept {
    if (report_.trap == Trap::lost || report_.trap == Trap::fallback) return false;
    report_.trap = Trap::none;
    set_outputs(now());
    report_.asked = now();
    // The coupler may have taken its time: the rest begins when the output is off for certain.
    if (std::exchange(went_off_, false)) off_ = report_.asked;
    if (report_.trap != Trap::lost) read_inputs();
    report_.answered = now();
    if (report_.trap != Trap::lost) judge(report_.answered);
    if (report_.trap != Trap::lost) look_after();
    return report_.trap != Trap::lost && report_.trap != Trap::fallback;
  }
  [[nodiscard]] const Report& report() const noexcept { return report_; }

 private:
  [[nodiscard]] Drive wanted() const noexcept;
  bool did(Outcome outcome) noexcept;  // keeps the reason otherwise
  bool prepare() noexcept;             // the coupler's watchdog, before the first output
  void set_outputs(Duration now) noexcept;
  bool write(Drive which, bool on) noexcept;  // writes an output and reads it back
  void read_inputs() noexcept;
  void judge(Duration now) noexcept;
  void look_after() noexcept;  // one of the coupler's states in turn

  Coupler& coupler_;
  GripperSettings settings_;
  Jaws jaws_;
  Sensors sensors_;
  Report report_;
  Order order_;
  Drive set_ = Drive::none;
  Duration off_{};  // since both outputs are off
  bool prepared_ = false, bus_ = true, looks_at_bus_ = false, was_on_ = false, went_off_ = false;
};

}  // namespace enc::gripper
