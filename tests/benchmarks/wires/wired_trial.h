// The product's loop with its devices behind their wires, in virtual time (hw_drivers/wires/wires.h). Also
// how long a machine still moves after its last set-point, which is stated for every fault.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/machine/servo.h"
#include "hw_drivers/wires/wires.h"
#include "models/setup/scene_file.h"
#include "trial/devices/device_log.h"
#include "trial/trial.h"

namespace enc::bench::wires {

inline constexpr double kStands = 1e-4;  // m/s: a slower machine is at standstill

// Returns the time in s until the machine stays slower than `stands` (m/s), infinite if it still moves after
// 5 s. It starts at `speed` with its last point ahead, no farther than it needs to brake: set-points that a
// machine can follow leave no other. The law is followed for every such point, because a servo with clipped
// acceleration overshoots, comes back too fast, and repeats that.
[[nodiscard]] inline double longest_settling(const ServoLaw& law, double speed, double stands) noexcept {
  constexpr int kPoints = 100;
  constexpr double kStep = 1e-3;  // s
  constexpr int kSteps = 5000;
  const double brakes = 0.5 * speed * speed / law.acceleration;
  double longest = 0.0;
  for (int i = 0; i <= kPoints; ++i) {
    const Vec3 last(brakes * i / kPoints, 0.0, 0.0);
    ServoMotion motion;
    motion.velocity.x() = speed;
    double moved = 0.0;
    // A slow machine so near its point that it cannot become faster stays slow.
    for (int step = 1; step <= kSteps; ++step) {
      follow(law, last, kStep, motion);
      if (motion.velocity.norm() >= stands) moved = kStep * step;
      if (kStep * step - moved > 1.0 / law.frequency) break;
    }
    if (moved >= kStep * kSteps) return std::numeric_limits<double>::infinity();
    longest = std::max(longest, moved);
  }
  return longest;
}

using enc::wires::WireChoice;
using enc::wires::Wires;

// The wires around a trial; construct it before the trial.
class Laboratory {
 public:
  // `setup` with every value of the drivers' tables, defaults included.
  explicit Laboratory(models::Setup setup, WireChoice which = {true, true, true}, std::uint64_t seed = 1);
  [[nodiscard]] const models::Setup& setup() const { return setup_; }
  // Returns the options with their devices behind the wires.
  [[nodiscard]] trial::TrialOptions behind(trial::TrialOptions options);
  [[nodiscard]] Wires& wires() { return wires_; }

 private:
  models::Setup setup_;
  WireChoice which_;
  Wires wires_;
  trial::DeviceLog log_;
};

class WiredTrial {
 public:
  WiredTrial(models::Setup setup, trial::TrialOptions options, WireChoice which = {true, true, true})
      : laboratory_(std::move(setup), which, options.seed),
        trial_(laboratory_.setup(), laboratory_.behind(std::move(options))) {}

  bool tick() { return trial_.tick(); }
  [[nodiscard]] trial::Trial& trial() { return trial_; }
  [[nodiscard]] Wires& wires() { return laboratory_.wires(); }

 private:
  Laboratory laboratory_;
  trial::Trial trial_;
};

// Result of a press of the ball: a complete trial, with wires or without.
struct PressResult {
  int contacts = 0;
  bool held = false;           // held after the first samples
  double peak = 0.0;           // N, ground truth
  double touched = kUnset;     // s, when the core first detects it
  std::vector<double> height;  // m, of the true tip, on each tick
};
inline constexpr double kOnePress = 20.0;  // s: the first press of tennis_ball is over
[[nodiscard]] PressResult pressed(trial::Trial& trial);

}  // namespace enc::bench::wires
