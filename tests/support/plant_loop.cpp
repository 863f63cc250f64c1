#include "tests/support/plant_loop.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "sim/truth/random.h"

namespace enc::test {
std::vector<models::LoopPoint> plant_loop(const sim::BallParameters& ball, double speed, double limit) {
  if (!(speed > 0.0) || !(limit > 0.0) || !(limit / speed < 3600.0))
    throw Error("the ball is pressed at a positive speed, to a positive limit, within an hour");
  constexpr double kPeriod = 1e-3;  // s
  const auto count = std::max(1L, std::lround(limit / (speed * kPeriod)));
  const sim::BallPlant plant(ball);
  sim::BallPlantState state;
  std::vector<models::LoopPoint> loop;
  loop.reserve(static_cast<std::size_t>(2 * count));
  for (long i = 1; i <= 2 * count; ++i) {
    const auto steps = static_cast<double>(std::min(i, 2 * count - i));
    const double deflection = limit * steps / static_cast<double>(count);
    loop.push_back({deflection, plant.step(state, deflection, kPeriod), i <= count});
  }
  return loop;
}

std::string plant_loop_csv(const sim::BallParameters& ball, double speed, double limit) {
  constexpr double kNoise = 0.0125;  // N rms
  constexpr double kStep = 0.025;    // N, of the force sensor
  constexpr int kRepeats = 5;
  const std::vector<models::LoopPoint> loop = plant_loop(ball, speed, limit);
  sim::Stream random(1, "plant_loop");
  std::string text = fmt::format(
      "# SYNTHETIC, not measured: plant formula of a ball, sim/ball_plant, E {:.2f} MPa, p {:.0f} kPa, "
      "{:.1f} mm/s\n"
      "time_s,deflection_mm,force_N,repeat\n",
      ball.rubber_modulus * 1e-6, ball.pressure * 1e-3, speed * 1e3);
  long row = 0;
  for (int repeat = 1; repeat <= kRepeats; ++repeat)
    for (const models::LoopPoint& p : loop) {
      const double force = kStep * std::round((p.force + kNoise * random.normal()) / kStep);
      text += fmt::format("{:.3f},{:.6f},{:.3f},{}\n", static_cast<double>(++row) * 1e-3, p.deflection * 1e3,
                          force, repeat);
    }
  return text;
}

double law_force(double deflection_mm, bool pressing) {
  if (!(deflection_mm > 0.0)) return 0.0;
  const double press = 1.05 * deflection_mm + 0.155 * deflection_mm * deflection_mm;
  return pressing ? press : 0.74 * press - 0.08 * std::min(deflection_mm, 1.0);
}

std::string law_loop_csv(const LawLoop& loop, std::uint64_t seed) {
  constexpr double kDeepest = 6.0;    // mm
  constexpr double kRelaxing = 0.6;   // s
  constexpr double kPause = 2.0;      // s, without rows
  constexpr double kOvershoot = 0.1;  // s
  sim::Stream random(seed, "law_loop");
  std::string text = "time_s,deflection_mm,force_N,repeat\n";
  const double way = kDeepest + loop.clear_mm, in = way / loop.in_mm_s, out = way / loop.out_mm_s;
  const double lasts = in + loop.hold_s + out;
  const auto rows = static_cast<long>(std::floor(lasts * loop.rate_Hz));
  for (int repeat = 1; repeat <= loop.repeats; ++repeat) {
    const double zero = loop.zero_N + loop.zero_drift_N * (repeat - 1);
    for (long i = 0; i <= rows; ++i) {
      const double t = static_cast<double>(i) / loop.rate_Hz;
      const bool pressing = t <= in + loop.hold_s;
      double d = std::min(
          {-loop.clear_mm + loop.in_mm_s * t, kDeepest, -loop.clear_mm + loop.out_mm_s * (lasts - t)});
      if (t > in && pressing) d += loop.overshoot_mm * std::max(0.0, 1.0 - (t - in) / kOvershoot);
      const double held = std::clamp(t - in, 0.0, loop.hold_s);
      const double force = law_force(d, pressing) *
                           (pressing ? 1.0 - loop.relaxes * (1.0 - std::exp(-held / kRelaxing)) : 1.0);
      const double read_mm = d + loop.begin_mm + loop.deflection_noise_mm * random.normal();
      text += fmt::format("{:.4f},{:.4f},{:.4f},{}\n", (repeat - 1) * (lasts + kPause) + t, read_mm,
                          force + zero + loop.force_noise_N * random.normal(),
                          loop.marks_all || read_mm > 0.0 ? repeat : 0);
    }
  }
  return text;
}

trial::Pushes ball_pushes(const sim::BallParameters& ball, const PushProgramme& programme) {
  const sim::BallPlant plant(ball);
  sim::BallPlantState state;
  trial::Pushes pushes;
  const double way = programme.depth / programme.speed;  // s
  const auto ticks = static_cast<int>(std::lround((2.0 * way + programme.dwell) / programme.period));
  double time = 1.0;
  for (int push = 0; push < programme.repeats; ++push) {
    pushes.emplace_back();
    for (int i = 1; i < ticks; ++i) {
      const double t = i * programme.period;
      const double left = ticks * programme.period - t;
      const double deflection = std::min({programme.speed * t, programme.depth, programme.speed * left});
      time += programme.period;
      pushes.back().push_back(
          {deflection, plant.step(state, deflection + programme.nearer, programme.period), true, time});
    }
    time += programme.rest;
    plant.step(state, 0.0, programme.rest);
  }
  return pushes;
}

void add_noise(trial::Pushes& pushes, std::uint64_t seed) {
  constexpr double kNoise = 0.0125, kQuantum = 0.025, kZero = 0.003;  // N
  constexpr double kWalk = 0.002;                                     // N / sqrt(s)
  sim::Stream random(seed, "ball_pushes");
  for (auto& push : pushes) {
    double zero = kZero * random.normal();
    double before = push.front().time;
    for (models::LoopPoint& p : push) {
      zero += kWalk * std::sqrt(p.time - before) * random.normal();
      before = p.time;
      p.force = kQuantum * std::round((p.force + zero + kNoise * random.normal()) / kQuantum);
    }
  }
}

}  // namespace enc::test
