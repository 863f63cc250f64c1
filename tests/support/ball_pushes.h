// Pushes of the plant formula alone with times and a dwell, for tests of what is identified from them.
#pragma once

#include <cstdint>

#include "sim/bodies/ball_plant.h"
#include "trial/identify/ball/ball_loops.h"

namespace enc::test {

struct PushProgramme {
  double speed = 20e-3;  // m/s
  double depth = 6e-3;   // m
  double dwell = 4.0;    // s
  double rest = 2.0;     // s, clear of the ball
  int repeats = 2;
  double period = 1e-3;  // s
  double nearer = 0.0;   // m: the ball stands so much nearer than the deflection says
};

// Without noise.
[[nodiscard]] trial::Pushes ball_pushes(const sim::BallParameters& ball, const PushProgramme& programme);

// A sensor as the simulated one: white noise, steps, a zero that wanders and is found anew before each push.
void add_noise(trial::Pushes& pushes, std::uint64_t seed);

}  // namespace enc::test
