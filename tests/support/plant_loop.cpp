#include "tests/support/plant_loop.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/random.h"

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

}  // namespace enc::test
