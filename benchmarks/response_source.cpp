#include "benchmarks/response_source.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/response.h"
#include "models/response_file.h"

namespace enc::bench {
namespace {

// Rounds to 1e-8 N/mm^k, 1e-5 N at 6 mm: so the file is the same whatever the compiler did to the last bits
// of the fit. By way of text, because the file's numbers are decimals in N/mm^k: value = n * 10^(3 k - 8)
// N/m^k.
ResponseSpec rounded(ResponseSpec spec) {
  const auto decimal = [](double si, int k) {
    const auto n = std::llround(si * std::pow(10.0, 8 - 3 * k));
    return std::stod(fmt::format("{}e{}", n, 3 * k - 8));
  };
  for (int k = 1; k <= 4; ++k) {
    const auto i = static_cast<std::size_t>(k - 1);
    spec.press[i] = decimal(spec.press[i], k);
    spec.release[i] = decimal(spec.release[i], k);
  }
  return spec;
}

}  // namespace

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

double fit_floor(const LoopModel& loop) {
  // Two figures for the softest object that the loop renders stably: the linear theory, and 0.17 of the
  // hand's stiffness (decisions 2: what simulated presses gave for a softer hand). The larger, and 5 % so
  // that a file is not refused for its last digit.
  constexpr double kShare = 0.17;
  constexpr double kMargin = 1.05;
  return kMargin * std::max(lowest_stable_stiffness(loop), kShare * loop.hand_stiffness);
}

std::string plant_response_text(const sim::BallParameters& ball, double speed, double limit,
                                const LoopModel& loop) {
  const double floor = fit_floor(loop);
  const models::ResponseFit fit = models::fit_response(plant_loop(ball, speed, limit), limit, floor);
  const std::string source = fmt::format(
      "SYNTHETIC, not measured: computed from the plant formula of a soft tennis ball (sim/ball_plant: E "
      "{:.2f} MPa, p {:.0f} "
      "kPa) by `encounter response --out models/responses/tennis_ball.toml`; one press from rest to {:.1f} "
      "mm and back at {:.1f} "
      "mm/s, read at 1 kHz, no noise, no quantisation; slope at least {:.3f} N/mm; RMSE press {:.3f}, "
      "release {:.3f} N "
      "(without constraints {:.3f}, {:.3f} N)",
      ball.rubber_modulus * 1e-6, ball.pressure * 1e-3, limit * 1e3, speed * 1e3, floor * 1e-3,
      fit.rmse_press, fit.rmse_release, fit.rmse_press_free, fit.rmse_release_free);
  return models::response_text(rounded(fit.spec), source);
}

}  // namespace enc::bench
