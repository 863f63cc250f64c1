#include "core/safety/certificate/release.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace enc::certificate {
namespace {

// The device: exact where it is neither damped nor held; damper and hand in second order of the step.
struct Slide {
  double mass = 1.0, damping = 0.0, spring = 0.0, friction = 0.0;
  double x = 0.0, v = 0.0;

  [[nodiscard]] double pull(double force, double sign, double at, double speed) const {
    return (force - friction * sign - damping * speed - spring * at) / mass;
  }
  // Over h, s, under a constant force. Where it stops on the way, friction decides anew.
  void glide(double force, double h) {
    while (h > 0.0) {
      const double push = force - spring * x;
      if (v == 0.0 && std::abs(push) <= friction) return;
      const double sign = v != 0.0 ? std::copysign(1.0, v) : std::copysign(1.0, push);
      const double half = v + 0.5 * h * pull(force, sign, x, v);
      const double after = v + h * pull(force, sign, x + 0.5 * h * v, half);
      if (after * sign <= 0.0) {
        if (v == 0.0) return;
        const double stops = h * v / (v - after);
        x += 0.5 * v * stops;
        v = 0.0;
        h -= stops;
        continue;
      }
      x += 0.5 * h * (v + after);
      v = after;
      return;
    }
  }
};

// The law, with all that it remembers.
struct Law {
  const SampledLoop& loop;
  double stiffness, damper, count;
  Late delay = late(loop);
  double error = 0.0, rate = 0.0;
  std::vector<double> readings{}, forces{};  // newest first

  [[nodiscard]] double read(double x) const {
    return count > 0.0 ? count * (std::floor(x / count) + 0.5) : x;
  }
  void begin(double x) {
    error = read(x);
    readings.assign(static_cast<std::size_t>(loop.ticks), error);
    forces.assign(static_cast<std::size_t>(delay.whole) + 2, -stiffness * error);
  }
  void tick(double x) {
    const double now = read(x), speed = (now - readings.back()) / (loop.ticks * loop.period);
    std::rotate(readings.begin(), readings.end() - 1, readings.end());
    readings.front() = now;
    const double a = loop.filter;
    error = std::isnan(a) ? now : (a * now + error) / (1.0 + a);
    rate = std::isnan(a) ? speed : (a * speed + rate) / (1.0 + a);
    std::rotate(forces.begin(), forces.end() - 1, forces.end());
    forces.front() = -(stiffness * error + damper * rate);
  }
};

// From peak to peak, of each quarter of the time.
struct Swings {
  double low[4], high[4];
  Swings() {
    std::fill_n(low, 4, std::numeric_limits<double>::infinity());
    std::fill_n(high, 4, -std::numeric_limits<double>::infinity());
  }
  void see(std::size_t quarter, double x) {
    low[quarter] = std::min(low[quarter], x);
    high[quarter] = std::max(high[quarter], x);
  }
  [[nodiscard]] double of(std::size_t quarter) const { return high[quarter] - low[quarter]; }
};

// Long enough for a hundred swings, and short enough to wait for.
int ticks_of(const SampledLoop& loop, double stiffness) {
  constexpr double kSwings = 100.0, kLeast = 0.5, kMost = 40000;
  const double turning = std::sqrt((stiffness + loop.hand.stiffness) / (loop.mass + loop.hand.mass));
  const double seconds = std::max({kLeast, kSwings * 6.3 / turning, 40.0 * loop.delay});
  return static_cast<int>(std::clamp(seconds / loop.period, 400.0, kMost));
}

// Parts of a step that are short for the device itself.
int parts_of(const SampledLoop& loop, double span) {
  constexpr double kFine = 0.02;
  const double mass = loop.mass + loop.hand.mass;
  const double quickest =
      std::max(std::sqrt(loop.hand.stiffness / mass), (loop.damping + loop.hand.damping) / mass);
  return static_cast<int>(std::clamp(std::ceil(span * quickest / kFine), 4.0, 4000.0));
}

Rest judge(const Swings& swings, double disturbance) {
  if (swings.of(3) <= std::max(0.01 * disturbance, 0.9 * swings.of(2))) return Rest::still;
  return swings.of(3) > 1.1 * swings.of(2) ? Rest::away : Rest::cycle;
}

}  // namespace

Released release(const SampledLoop& loop, const Steps& steps, double stiffness, double damper,
                 double disturbance) {
  if (!loop.known() || !(steps.friction >= 0.0) || !(steps.encoder >= 0.0) ||
      !std::isfinite(steps.friction) || !std::isfinite(steps.encoder) || !(stiffness >= 0.0) ||
      !std::isfinite(stiffness) || !std::isfinite(damper) || !(disturbance > 0.0) ||
      !std::isfinite(disturbance))
    return {};
  Slide slide{loop.mass + loop.hand.mass,
              loop.damping + loop.hand.damping,
              loop.hand.stiffness,
              steps.friction,
              disturbance,
              0.0};
  Law law{loop, stiffness, damper, steps.encoder};
  law.begin(slide.x);
  const int ticks = ticks_of(loop, stiffness);
  const double first = law.delay.part * loop.period, rest = loop.period - first;
  const int first_parts = first > 0.0 ? parts_of(loop, first) : 0, rest_parts = parts_of(loop, rest);
  const auto whole = static_cast<std::size_t>(law.delay.whole);
  Swings swings;
  for (int i = 0; i < ticks; ++i) {
    law.tick(slide.x);
    for (int k = 0; k < first_parts; ++k) slide.glide(law.forces[whole + 1], first / first_parts);
    for (int k = 0; k < rest_parts; ++k) slide.glide(law.forces[whole], rest / rest_parts);
    swings.see(static_cast<std::size_t>(4 * i / ticks), slide.x);
    if (!(std::abs(slide.x) < 20.0 * disturbance))
      return {Rest::away, 2.0 * std::abs(slide.x), (i + 1) * loop.period};
  }
  return {judge(swings, disturbance), swings.of(3), ticks * loop.period};
}

}  // namespace enc::certificate
