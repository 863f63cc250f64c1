#include "core/control/scene/steadiness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "core/control/safety/inside.h"
#include "core/control/scene/scene.h"
#include "core/control/stages/step_context.h"
#include "core/control/track/reach.h"
#include "core/spec/rig_spec.h"

namespace enc {
namespace {

constexpr double kHold = 6.0, kWatched = 3.0;        // s
constexpr std::array kDepths{1.0, 0.75, 0.5, 0.25};  // shares of the largest depth that are tried
constexpr double kWaits = 2e-3;                      // m above the surface, start of the push
// Contact threshold over the rms of a disturbance that could start a sustained oscillation: 0.1 N over 0.02
// N. The latter is the noise of the paper's sensor (0.0144 N with its steps) and the operator's tremor.
constexpr double kOverNoise = 5.0;
// Largest difference between the twin and the loop here (derived: docs/notes/stiffness.md).
constexpr double kMargin = 1.1;
constexpr double kCareful = 0.75;  // share of kStill, for that reason

// White noise of rms 1, identical in every run.
struct Noise {
  std::uint64_t state = 1;
  double operator()() {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (static_cast<double>(state >> 40) / static_cast<double>(1ULL << 24) - 0.5) * std::sqrt(12.0);
  }
};

// Second order with limits, like machines of this kind.
struct Machine {
  double at = 0.0, speed = 0.0;
  void move(double wanted, const LoopModel& loop, double acceleration, double most, double h) {
    const double w = 2.0 * std::numbers::pi * loop.servo_hz;
    const double pull = w * w * (wanted - at) - 2.0 * loop.servo_damping * w * speed;
    speed = std::clamp(speed + h * std::clamp(pull, -acceleration, acceleration), -most, most);
    at += h * speed;
  }
};

// The guard's limits in one dimension.
struct Command {
  double at = 0.0, speed = 0.0;
  void go(double target, double acceleration, double most, double dt) {
    const double way = target - at, distance = std::abs(way);
    const double along = acceleration * stages::kAlongShare;
    const double fast = std::min(approach_speed(distance, along, dt), most);
    speed += std::clamp(std::copysign(fast, way) - speed, -along * dt, along * dt);
    at += dt * speed;
  }
};

// N: a hand that goes along `way` within `ramp`, of which it has come so far in time (`share`), and the
// machine gives in.
double push_of_hand(const LoopModel& loop, double way, double share, double ramp, const Machine& machine) {
  const MinimumJerk hand(share);
  return loop.hand_stiffness * (way * hand.x - kWaits - machine.at) +
         loop.hand_damping * (way * hand.v / ramp - machine.speed);
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void see(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

LoopModel with_margin(LoopModel loop) {
  loop.hand_stiffness *= kMargin;
  loop.hand_damping *= kMargin;
  return loop;
}

}  // namespace
   // machine gives way.

Steadiness::Steadiness(const RigSpec& rig)
    : loop_(with_margin(loop_of(rig))),
      acceleration_(rig.manipulator.acceleration),
      speed_(rig.manipulator.speed),
      filter_gain_(1.0 - std::exp(-2.0 * std::numbers::pi * rig.force.filter / rig.loop.rate)),
      dt_(1.0 / rig.loop.rate),
      threshold_(rig.force.threshold),
      contact_(rig.force.contact) {
  if (rig.admittance.damping == Damping::observed)
    law_.emplace(rig.admittance, loop_, filter_gain_, stages::kAlongShare * acceleration_, dt_);
}

double Steadiness::swing(const Response& object, double depth, double limit, double ramp,
                         double share) const {
  // Take at least 40 steps in the servo's period and at least 4 in 1 ms.
  const auto steps = static_cast<int>(std::ceil(dt_ * std::max(4e3, 40.0 * loop_.servo_hz)));
  const double h = dt_ / steps;
  const auto late = static_cast<std::size_t>(std::max<std::int64_t>(1, std::llround(loop_.delay / dt_)));
  std::vector<double> sent(late, 0.0);
  const double way = depth + share * object.press(depth) / loop_.hand_stiffness + kWaits;
  const auto ticks = static_cast<std::size_t>((ramp + kHold) / dt_);
  const auto watched = static_cast<std::size_t>((ramp + kHold - kWatched) / dt_);
  Machine machine;
  Command command;
  Noise noise;
  ResponseState at;
  std::optional<Swing> seen;
  double force = 0.0, carried = 0.0;
  Range range;
  for (std::size_t i = 0; i < ticks; ++i) {
    double& due = sent[i % late];
    for (int k = 0; k < steps; ++k) machine.move(due, loop_, acceleration_, speed_, h);
    const double push = push_of_hand(loop_, way, static_cast<double>(i) * dt_ / ramp, ramp, machine);
    force += filter_gain_ * (std::max(0.0, push) + noise() * contact_ / kOverNoise - force);
    if (!seen && force > contact_)
      seen = law_ ? law_->begin(share * object.press(1e-3 * limit) / (1e-3 * limit), force, machine.at)
                  : Swing{};
    const double pressed = std::max(0.0, force - threshold_);
    double target = 0.0;
    if (seen) {
      // A softer object scales up everything that pushes on it, and with it the damper's part.
      carried = law_ ? share * law_->carry(object, at, carried / share, pressed / share,
                                           law_->observe(*seen, force, machine.at) / share, limit)
                     : pressed;
      target = object.deflection(at, carried / share, limit);
    }
    command.go(target, acceleration_, speed_, dt_);
    due = command.at;
    if (i >= watched) range.see(machine.at);
  }
  return range.high - range.low;
}

double Steadiness::still() const { return std::max(kStill, threshold_ * kMargin / loop_.hand_stiffness); }

Steadiness::WorstDepth Steadiness::worst(const Response& object, double limit, double ramp,
                                         double share) const {
  WorstDepth worst;
  for (const double part : kDepths) {
    const double here = swing(object, part * limit, limit, ramp, share);
    if (here > kCareful * still() && here > worst.swing) worst = {part * limit, here};
  }
  return worst;
}

bool Steadiness::stands(const Response& object, double deepest, double limit, double ramp,
                        double share) const {
  return std::none_of(kDepths.begin(), kDepths.end(), [&](double part) {
    return swing(object, part * deepest, limit, ramp, share) > kCareful * still();
  });
}

double Steadiness::least_share(const Response& object, double limit, double ramp) const {
  constexpr double kNear = 1.1;
  const auto so_soft = [&](double share) { return stands(object, limit, limit, ramp, share); };
  if (so_soft(kLeastShare)) return kLeastShare;
  double high = 1.0, low = kLeastShare;
  while (high / low > kNear) {
    const double middle = std::sqrt(low * high);
    (so_soft(middle) ? high : low) = middle;
  }
  return high;
}

double Steadiness::softest(double depth, double force, double ramp) const {
  const auto so_soft = [&](double k) {
    const double most = std::min(depth, force / k), limit = 1.5 * most;
    const Response spring({{k, 0, 0, 0}, {k, 0, 0, 0}, limit}, 0.0);
    return stands(spring, most, limit, ramp);
  };
  constexpr double kSteps = 1.3, kNear = 1.02;
  double high = 8.0 * loop_.hand_stiffness;  // any useful loop is stable at this stiffness
  while (!so_soft(high) && high < 1e6) high *= 2.0;
  double low = high / kSteps;
  while (so_soft(low)) {
    if (low < least_felt(depth)) return least_felt(depth);
    high = low;
    low /= kSteps;
  }
  while (high / low > kNear) {
    const double middle = std::sqrt(low * high);
    (so_soft(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace enc
