// What every force-controlled arm has in common: the exchange between the loop and the device's own thread,
// and a watch over that thread.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/latest.h"
#include "core/base/sample.h"
#include "core/devices/driver.h"
#include "hw_drivers/arm/force_guard.h"

namespace enc::arm {

// One reading of the device's thread.
struct ArmReading {
  ArmSample sample;
  Duration at{};        // steady clock
  bool pressed = true;  // the dead man's switch is closed, or there is none
  int error = 0;        // number of the vendor; 0: no error
  double warmth = 0.0;  // warmest motor, 1: too hot; 0: unknown
};

struct ServoSettings {
  GuardLimits guard;
  double silent = 0.004;  // s: longest time without a turn; then the link is lost
  double hottest = 1.0;   // warmth that counts as an error
  bool watched = true;    // false: without the watch, for tests
};

class Servo {
 public:
  // cut: switches the device's force off, from any thread. words: text for an error number. `log` must
  // outlive the servo.
  Servo(const ServoSettings& settings, Log& log, std::function<void()> cut,
        std::function<std::string(int)> words);
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;
  ~Servo();

  // ---- the device's thread
  // Call in each of its periods: hands the reading to the loop and returns the force to exert.
  Vec<'R'> turn(const ArmReading& reading) noexcept;
  // Call before each turn: the motors are on from the loop's first force to its next stop. `device` has
  // switch_on() and switch_off(). An arm whose motors are off is braked by them.
  template <class Device>
  void switch_motors(Device& device) {
    const bool on = order_.number > 0 && !order_.stopped && linked();
    if (on == motors_on_) return;
    motors_on_ = on;
    on ? device.switch_on() : device.switch_off();
    if (on && !linked()) device.switch_off();  // lost in between
  }
  [[nodiscard]] bool motors_on() const noexcept { return motors_on_; }
  // Ends all force for the rest of the run. Call it from any thread.
  void lose(const std::string& why) noexcept;

  // ---- the loop
  Measurement<ArmSample> read(Time now) noexcept;
  void command(const Vec<'R'>& force) noexcept;
  void stop() noexcept;
  [[nodiscard]] bool linked() const noexcept { return !lost_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::vector<std::string> remarks(const std::string& name) const;
  // Waits until the device's thread has come at least once; false: not within this time, s.
  [[nodiscard]] bool comes(double within) const;
  void end() noexcept;  // ends the watch and all force; the device's thread may stop now
  // s since the last turn; 0 before the first.
  [[nodiscard]] double silence() const noexcept;

 private:
  struct Report {
    ArmReading reading;
    bool faulty = false;  // an error, now or just before
    GuardCounts counts;
  };
  void watch() noexcept;

  ServoSettings settings_;
  Log& log_;
  std::function<void()> cut_;
  std::function<std::string(int)> words_;

  // Data of the device's thread.
  ForceGuard guard_;
  ForceOrder order_;
  bool motors_on_ = false;

  // Data of the loop.
  ForceOrder given_;
  Report report_;
  Duration tick_{};
  Time stamp_{};
  bool read_ = false, refused_ = false;

  // Shared by both.
  LatestValue<ForceOrder> orders_;
  LatestValue<Report> reports_;
  std::atomic<Duration::rep> turned_ = 0, longest_ = 0;  // ns: the last turn; longest time between two
  std::atomic<std::int64_t> turns_ = 0, errors_ = 0, opened_ = 0;
  std::atomic<int> error_ = 0;        // the last one
  std::atomic<double> warmth_ = 0.0;  // the largest
  std::atomic<bool> lost_ = false, end_ = false;
  std::thread watch_;
};

}  // namespace enc::arm
