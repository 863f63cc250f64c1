// Loops and pushes of the plant formula alone, without a rig: the readings of a press on an ideal machine.
// For tests and benchmarks, and for balls that no rig has pressed yet.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/identify/response/response_fit.h"
#include "sim/bodies/ball_plant.h"
#include "trial/identify/ball/ball_fit.h"

namespace enc::test {

// One press from rest to `limit` (m) and back at `speed` (m/s), read at 1 kHz, without noise or quantisation.
[[nodiscard]] std::vector<models::LoopPoint> plant_loop(const sim::BallParameters& ball, double speed,
                                                        double limit);

// Five such presses, with the force sensor's noise (0.0125 N rms) and steps (0.025 N), as a file for
// `encounter fit`. Its first line says that it is synthetic.
[[nodiscard]] std::string plant_loop_csv(const sim::BallParameters& ball, double speed, double limit);

// A rig that presses an object of one law at constant speeds; its loop is a file for `encounter fit`.
struct LawLoop {
  double in_mm_s = 4.0, out_mm_s = 4.0;
  double hold_s = 0.0;
  double relaxes = 0.0;  // share of the force, within a few seconds of the hold
  double rate_Hz = 1000.0;
  double deflection_noise_mm = 0.003, force_noise_N = 0.02;  // rms
  // Zero of the force: of all presses, and its drift between presses
  double zero_N = 0.0, zero_drift_N = 0.0;
  double begin_mm = 0.0;      // deflection_mm where contact begins
  double clear_mm = 2.0;      // starts and ends this far outside
  double overshoot_mm = 0.0;  // beyond the hold, for a tenth of a second
  int repeats = 5;
  bool marks_all = false;  // rows outside contact have a `repeat`, too
};
// N at a deflection in mm: 11.88 N pressing and 8.71 N releasing at 6 mm.
[[nodiscard]] double law_force(double deflection_mm, bool pressing);
[[nodiscard]] std::string law_loop_csv(const LawLoop& loop, std::uint64_t seed);

// Pushes of the plant formula alone with times and a dwell, for tests of identification.
struct PushProgramme {
  double speed = 20e-3;  // m/s
  double depth = 6e-3;   // m
  double dwell = 4.0;    // s
  double rest = 2.0;     // s, clear of the ball
  int repeats = 2;
  double period = 1e-3;  // s
  double nearer = 0.0;   // m: the ball stands nearer than the deflection says
};

// Pushes without noise.
[[nodiscard]] trial::Pushes ball_pushes(const sim::BallParameters& ball, const PushProgramme& programme);

// Adds the errors of the simulated sensor: white noise, steps, and a wandering zero that is tared before each
// push.
void add_noise(trial::Pushes& pushes, std::uint64_t seed);

}  // namespace enc::test
