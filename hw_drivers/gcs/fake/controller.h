// A C-887 as its clients see it: GCS 2 in, GCS 2 out, in front of any machine of the core. It knows neither
// sockets nor clocks.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "core/devices/manipulator.h"
#include "hw_drivers/gcs/fake/points.h"
#include "hw_drivers/gcs/fake/profile.h"
#include "hw_drivers/gcs/wire/error_text.h"
#include "hw_drivers/gcs/wire/text.h"
#include "hw_drivers/gcs/wire/travel.h"

namespace enc::gcs {

// How hard it brakes, in its own acceleration: on HLT, and on STP, #24 or a servo that is off.
inline constexpr double kSmooth = 1.0, kAbrupt = 4.0;

struct ControllerSettings {
  // Of a fake: a part of its first field is kFakeName.
  std::string identity =
      "(c)2019 Physik Instrumente (PI) GmbH & Co. KG Encounter fake, C-887.53, 119000000, 2.10.0.1";
  std::string stage = "H-840.D2";
  bool referenced = true;         // else FRF is needed, as after power-on
  double velocity = 0.05;         // VLS at power-on, m/s
  double most_velocity = 0.1;     // m/s
  double origin_height = 0.1845;  // of its coordinates above R, m
  // What a set-point lets happen; empty: time goes on by itself. With it a set-point goes to the machine as
  // it is, without a path of the controller's own: the machine moves while this runs.
  std::function<void()> advance{};
};

class Controller {
 public:
  Controller(Manipulator& machine, const ControllerSettings& settings);

  // Takes what a client sent, in any pieces; gives what it is answered, until the next call.
  [[nodiscard]] std::string_view take(std::string_view bytes);
  // Time goes on: each millisecond the machine is told and read.
  void cycle(Time now) noexcept;
  void forget_line() noexcept;  // a client is gone

  [[nodiscard]] bool at_rest() const noexcept { return !profile_.moving() && !points_.going(); }
  [[nodiscard]] const Coordinates& measured() const noexcept { return measured_; }
  [[nodiscard]] const Coordinates& aim() const noexcept { return profile_.aim(); }
  [[nodiscard]] int error() const noexcept { return error_; }  // that ERR? would say
  // How often it was told to move, be it refused or not: MOV, MVR, FRF.
  [[nodiscard]] std::int64_t told() const noexcept { return told_; }
  // How often it was commanded to stop: HLT, STP, #24.
  [[nodiscard]] std::int64_t stops() const noexcept { return stops_; }
  // For tests: something fails, as a strut may. The servos are off then.
  void fail(int error) noexcept;
  void mend() noexcept;  // and somebody has switched them on again

 private:
  friend struct Commands;  // the lines: commands.h

  void byte(char command);
  void line(std::string_view text);
  // Notes the error where it is one; says whether.
  bool wrong(bool bad, int error) noexcept;
  bool is_none(std::string_view word, std::string_view names) noexcept;  // of these axes
  void go(const Coordinates& to);
  void measure(Time now) noexcept;
  void stop(double hardness) noexcept;
  // "X=1 \nY=2\n" of the axes that the words name, of all where they name none.
  void say_axes(std::string_view words, std::string_view names, std::span<const std::string_view> values);
  void say_axes(std::string_view words, std::string_view names, std::span<const double> values);
  void say_flags(std::string_view words, std::span<const bool> values);
  void say(std::string_view line) { answer_.append(line).push_back('\n'); }
  // Reads "X 1 Z -0.5" into values; false, and noted, where it is none.
  bool read_pairs(std::string_view words, std::string_view names, std::span<double> values) noexcept;
  [[nodiscard]] bool within(const Coordinates& to) const noexcept;
  [[nodiscard]] Coordinates shown(const Coordinates& at) const noexcept;  // zero before it is referenced
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
  bool by_points_ = false;           // its path, and not one of its own
  double points_cycle_ = 0.010;      // s
  Coordinates measured_{}, seen_{};  // now, and when #6 asked last
  std::array<bool, kAxes> servo_{true, true, true, true, true, true};
  bool referenced_, referencing_ = false;
  double velocity_;
  int error_ = kNoError;
  std::int64_t told_ = 0, stops_ = 0;
  Text line_;
  bool long_ = false;  // the line is too long already
  std::string answer_;
  Time now_{};
  bool begun_ = false;
};

}  // namespace enc::gcs
