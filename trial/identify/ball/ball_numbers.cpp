#include "trial/identify/ball/ball_numbers.h"

#include <array>

#include "core/base/units.h"

namespace enc::trial {

std::span<const BallNumber> ball_numbers() {
  using Ball = StandingBall;
  static constexpr std::array<BallNumber, kBallNumbers> kAll{{
      {"rubber_modulus_MPa", kMegapascal, 2.6e6, true, true,
       [](Ball& b) -> double& { return b.law.rubber_modulus; }, "push deeper or more often"},
      {"pressure_kPa", kKilopascal, 10e3, true, false, [](Ball& b) -> double& { return b.law.pressure; },
       "push deeper or more often, or measure it and hold it"},
      {"felt_modulus_MPa", kMegapascal, 0.2e6, true, true,
       [](Ball& b) -> double& { return b.law.felt_modulus; },
       "push more often, or measure where the ball begins and hold nearer_mm"},
      {"friction", 1.0, 0.1, false, false, [](Ball& b) -> double& { return b.law.friction; },
       "come back as well as push, more often"},
      {"friction_travel_mm", kMillimetre, 0.6e-3, false, true,
       [](Ball& b) -> double& { return b.law.friction_travel; }, "come back as well as push, more often"},
      {"relaxing_fast", 1.0, 0.05, false, false, [](Ball& b) -> double& { return b.law.relaxing[0]; },
       "push faster (probe.speed_mm_s = 20)"},
      {"relaxing_middle", 1.0, 0.05, false, false, [](Ball& b) -> double& { return b.law.relaxing[1]; },
       "push faster and stay at depth (probe.dwell_s = 4)"},
      {"relaxing_slow", 1.0, 0.05, false, false, [](Ball& b) -> double& { return b.law.relaxing[2]; },
       "stay at depth (probe.dwell_s = 4), several times"},
      {"nearer_mm", kMillimetre, 0.1e-3, false, false, [](Ball& b) -> double& { return b.nearer; },
       "push more often"},
      {"wall_mm", kMillimetre, 3.5e-3, true, true, [](Ball& b) -> double& { return b.law.wall; },
       "measure it on a cut ball and hold it"},
      {"felt_mm", kMillimetre, 3e-3, true, true, [](Ball& b) -> double& { return b.law.felt; },
       "measure it and hold it: with felt_modulus only what both make together is known"},
      {"relaxation_fast_s", 1.0, 0.05, false, true, [](Ball& b) -> double& { return b.law.relaxation[0]; },
       "push faster (probe.speed_mm_s = 20)"},
      {"relaxation_middle_s", 1.0, 0.5, false, true, [](Ball& b) -> double& { return b.law.relaxation[1]; },
       "stay at depth (probe.dwell_s = 4), several times"},
      {"relaxation_slow_s", 1.0, 5.0, false, true, [](Ball& b) -> double& { return b.law.relaxation[2]; },
       "stay at depth for longer than it is"},
  }};
  return kAll;
}

}  // namespace enc::trial
