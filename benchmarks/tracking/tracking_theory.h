// What a chain of delays makes of a motion: the errors of Table 1 to be expected, from the numbers of the
// chain alone and without a simulator. A packet that reaches the core at a tick shows the tool where it was
// one age ago:
//   age = fixed delay + wait for the next server tick + exponential delay + wait for the next tick of the
//   core error = x(t - age) - x(t) + bias + noise
#pragma once

#include <cstddef>
#include <vector>

#include "trial/travel/travel_measure.h"

namespace enc::bench::tracking {

struct ChainSpec {
  double rate = 120.0, server_rate = 100.0;  // Hz, free-running
  double fixed = 0.0;                        // s, from exposure to server and in its application
  double jitter = 0.0;                       // s, mean of the exponential part
  double tick = 1e-3;                        // s, of the core
};

// `count` ages, s, each as likely as the others: means of equal parts of their distribution. A packet that is
// overtaken by a later one never counts.
[[nodiscard]] std::vector<double> likely_ages(const ChainSpec& chain, std::size_t count = 16);
[[nodiscard]] double mean_age(const ChainSpec& chain);

// One way along an axis from stop to stop, as the machine's servo makes it of the commanded trapezoids.
struct MovesSpec {
  std::vector<double> stops{0.0, 0.005, 0.010, 0.020, 0.040};  // m
  double speed = 0.020;                                        // m/s
  double acceleration = 0.41;                                  // m/s^2, of command and servo
  double servo = 15.0, damping = 0.8;                          // Hz, -
  double fastest = 0.050;                                      // m/s, of the servo
  double step = 1e-3;                                          // s, of the servo's simulation
};

using trial::Errors;
using trial::kMoving;

[[nodiscard]] Errors at_stops(double bias, double noise);

// Where the tool was an age ago less where it is, over all moving ticks and ages.
class Lag {
 public:
  Lag(const std::vector<double>& ages, const MovesSpec& moves);
  // way: 1 towards + of the axis, -1 towards -, 0 both. Bias (fixed in the room) and noise: m.
  [[nodiscard]] Errors errors(double bias, double noise, int way = 1) const;

 private:
  struct Bin {
    double lag = 0.0, share = 0.0;
  };
  std::vector<Bin> bins_;
  double mean_ = 0.0, square_ = 0.0;
};

}  // namespace enc::bench::tracking
