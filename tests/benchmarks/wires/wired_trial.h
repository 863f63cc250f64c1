// The product's loop with its devices behind their wires, in virtual time (hw_drivers/wires/wires.h).
// And how long a machine moves on after its last set-point, which is stated of every fault.
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

inline constexpr double kStands = 1e-4;  // m/s: a machine that is slower stands

// s until it stays slower than `stands` (m/s). At first it has this speed, and its last point is ahead, no
// farther than it needs to brake: set-points that a machine can follow leave no other. Infinite: after 5 s it
// still moves. Found by following the law for every such point: a servo whose acceleration is clipped passes
// its point, comes back too fast as well, and does so more than once.
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
    // Once slow, and so near that it can become no faster, it stays slow.
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
