// Loops of the plant formula alone, without a rig around it: what a press would read on an ideal machine. For
// tests and benchmarks, and for balls that no rig has pressed yet.
#pragma once

#include <string>
#include <vector>

#include "models/fit/response_fit.h"
#include "sim/bodies/ball_plant.h"

namespace enc::test {

// One press from rest to `limit` (m) and back at `speed` (m/s), read at 1 kHz, without noise or quantisation.
[[nodiscard]] std::vector<models::LoopPoint> plant_loop(const sim::BallParameters& ball, double speed,
                                                        double limit);

// The same five times over, with the force sensor's noise (0.0125 N rms) and steps (0.025 N), as a file for
// `encounter fit`. Says in its first line that it is synthetic.
[[nodiscard]] std::string plant_loop_csv(const sim::BallParameters& ball, double speed, double limit);

}  // namespace enc::test
