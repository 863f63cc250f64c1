#include "tests/support/ball_pushes.h"

#include <algorithm>
#include <cmath>

#include "sim/truth/random.h"

namespace enc::test {

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
