// One trial: a ball with drawn numbers in the test rig, through sensor, servo and haptic loop, and what the
// fit, which knows none of them, makes of the loop.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "models/setup/scene_file.h"
#include "trial/identify/ball/ball_fit.h"

namespace enc::bench::identification {

// What is pressed and how, and what the fit is told about it.
struct IdentificationCase {
  const char* id;
  const char* what;
  const char* scene;
  std::vector<std::string> settings{};
  bool draw_wall = false;    // 3.3 to 3.7 mm, what is sold
  bool free_wall = false;    // to be found, too
  bool hold_nearer = false;  // the ball is taken to stand where the scene says
};

struct IdentificationTrial {
  trial::StandingBall truth;
  trial::BallFit fit;
  double simulated = 0.0;  // s
  // Is the injected value inside of the interval?
  [[nodiscard]] bool holds(const trial::BallEstimate& estimate) const;
};

// What the rig of a set-up measures: readings while the probe presses.
[[nodiscard]] trial::Pushes pushes_of_run(const models::Setup& setup, std::uint64_t seed, double& simulated);

// Modulus within 15 %, the others within 30 % of the nominal ball, drawn by the seed.
[[nodiscard]] IdentificationTrial identify_once(const BenchContext& context, const IdentificationCase& which,
                                                std::uint64_t seed);

}  // namespace enc::bench::identification
