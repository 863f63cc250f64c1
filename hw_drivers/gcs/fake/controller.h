// Simulated C-887 controller for any machine of the core: GCS 2 text in and out. It uses neither sockets nor
// clocks.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "core/devices/device.h"
#include "hw_drivers/gcs/fake/path.h"
#include "hw_drivers/gcs/wire/coordinates.h"
#include "hw_drivers/gcs/wire/error_text.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {

// Deceleration, in units of its own acceleration: on HLT; and on STP, #24 or a servo that is off.
inline constexpr double kSmooth = 1.0, kAbrupt = 4.0;

struct ControllerSettings {
  // Identity of a fake: its first field contains kFakeName.
  std::string identity =
      "(c)2019 Physik Instrumente (PI) GmbH & Co. KG Encounter fake, C-887.53, 119000000, 2.10.0.1";
  std::string stage = "H-840.D2";
  bool referenced = true;         // false: FRF is needed, as after power-on
  double velocity = 0.05;         // VLS at power-on, m/s
  double most_velocity = 0.1;     // m/s
  double origin_height = 0.1845;  // height of its coordinates' origin above R, m
  // Advances time for each set-point; empty: time runs by itself. If set, a set-point goes to the machine
  // unchanged, without the controller's own path: the machine moves during this call.
  std::function<void()> advance{};
};

class Controller {
 public:
  Controller(Manipulator& machine, const ControllerSettings& settings);

  // Takes a client's bytes, in any pieces; returns the answer, valid until the next call.
  [[nodiscard]] std::string_view take(std::string_view bytes);
  // Advances time: commands and reads the machine each millisecond.
  void cycle(Time now) noexcept;
  void forget_line() noexcept;  // call this when a client leaves

  [[nodiscard]] bool at_rest() const noexcept { return !profile_.moving() && !points_.going(); }
  [[nodiscard]] const Coordinates& measured() const noexcept { return measured_; }
  [[nodiscard]] const Coordinates& aim() const noexcept { return profile_.aim(); }
  [[nodiscard]] int error() const noexcept { return error_; }  // the number that ERR? would report
  // Number of motion commands, including refused ones: MOV, MVR, FRF.
  [[nodiscard]] std::int64_t told() const noexcept { return told_; }
  // Number of stop commands: HLT, STP, #24.
  [[nodiscard]] std::int64_t stops() const noexcept { return stops_; }
  // Test aid: a fault, for instance of a strut. It switches the servos off.
  void fail(int error) noexcept;
  void mend() noexcept;  // clears the fault and switches the servos on again

 private:
  friend struct Commands;  // the command lines: commands.h

  void byte(char command);
  void line(std::string_view text);
  // Stores the error if `bad`; returns `bad`.
  bool wrong(bool bad, int error) noexcept;
  bool is_none(std::string_view word,
               std::string_view names) noexcept;  // true if the word names none of these axes
  void go(const Coordinates& to);
  void measure(Time now) noexcept;
  void stop(double hardness) noexcept;
  // "X=1 \nY=2\n" for the axes in `words`, or for all if it is empty.
  void say_axes(std::string_view words, std::string_view names, std::span<const std::string_view> values);
  void say_axes(std::string_view words, std::string_view names, std::span<const double> values);
  void say_flags(std::string_view words, std::span<const bool> values);
  void say(std::string_view line) { answer_.append(line).push_back('\n'); }
  // Reads "X 1 Z -0.5" into values; returns false and stores the error for invalid input.
  bool read_pairs(std::string_view words, std::string_view names, std::span<double> values) noexcept;
  [[nodiscard]] bool within(const Coordinates& to) const noexcept;
  [[nodiscard]] Coordinates shown(const Coordinates& at) const noexcept;  // zero before the reference move
  [[nodiscard]] std::array<bool, kAxes> on_target() const noexcept;
  [[nodiscard]] unsigned status() const noexcept;
  [[nodiscard]] bool all_on() const noexcept;

  Manipulator& machine_;
  ControllerSettings settings_;
  Reach reach_;
  Stand stand_;
  Travel travel_;
  Profile profile_;
  Points points_;
  bool by_points_ = false;           // the path is made of the client's points
  double points_cycle_ = 0.010;      // s
  Coordinates measured_{}, seen_{};  // now, and at the last #6
  std::array<bool, kAxes> servo_{true, true, true, true, true, true};
  bool referenced_, referencing_ = false;
  double velocity_;
  int error_ = kNoError;
  std::int64_t told_ = 0, stops_ = 0;
  Text line_;
  bool long_ = false;  // the line is already too long
  std::string answer_;
  Time now_{};
  bool begun_ = false;
};

}  // namespace enc::gcs
