// The product's loop with its devices behind their wires, in virtual time (hw_drivers/wires/wires.h).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "hw_drivers/wires/wires.h"
#include "models/setup/scene_file.h"
#include "trial/devices/device_log.h"
#include "trial/trial.h"

namespace enc::bench::wires {

using enc::wires::Which;
using enc::wires::Wires;

// What a trial goes through; it goes before this.
class Laboratory {
 public:
  // `setup` with every value of the drivers' tables, defaults included.
  explicit Laboratory(models::Setup setup, Which which = {true, true, true}, std::uint64_t seed = 1);
  [[nodiscard]] const models::Setup& setup() const { return setup_; }
  // The options with their devices behind the wires.
  [[nodiscard]] trial::TrialOptions behind(trial::TrialOptions options);
  [[nodiscard]] Wires& wires() { return wires_; }

 private:
  models::Setup setup_;
  Which which_;
  Wires wires_;
  trial::DeviceLog log_;
};

class WiredTrial {
 public:
  WiredTrial(models::Setup setup, trial::TrialOptions options, Which which = {true, true, true})
      : laboratory_(std::move(setup), which, options.seed),
        trial_(laboratory_.setup(), laboratory_.behind(std::move(options))) {}

  bool tick() { return trial_.tick(); }
  [[nodiscard]] trial::Trial& trial() { return trial_; }
  [[nodiscard]] Wires& wires() { return laboratory_.wires(); }

 private:
  Laboratory laboratory_;
  trial::Trial trial_;
};

// What a press of the ball comes to: a trial, with wires or without, to its end.
struct Pressed {
  int contacts = 0;
  bool held = false;           // after the first samples
  double peak = 0.0;           // N, true
  double touched = kUnset;     // s, when the core has first noticed it
  std::vector<double> height;  // m, of the true tip, on each tick
};
inline constexpr double kOnePress = 20.0;  // s: the first of tennis_ball has ended
[[nodiscard]] Pressed pressed(trial::Trial& trial);

}  // namespace enc::bench::wires
