// The best possible predictor for the pictures of a reach: an upper bound for the prop's being there in time.
// It uses the exact parameters of the simulated person and the time of touch, which no machine has. It tries
// every timing finely. Its prop is anywhere at once or is carried by an arm.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/frames.h"
#include "sim/spec/twin_spec.h"

namespace enc::bench::reaching {

// The pictures of a reach for a plane until the touch, in axes whose z is the plane's normal, 0 at the
// touching tip.
struct SeenReach {
  struct Picture {
    Vec3 at{kUnset, kUnset, kUnset};         // m
    double exposed = kUnset, told = kUnset;  // s
  };
  std::vector<Picture> pictures;          // pictures in the order of time
  double met = kUnset;                    // s
  Eigen::Vector2d where{kUnset, kUnset};  // x and y of the tip at the touch
};

struct IdealSpec {
  sim::HandTruth hand;
  double noise = 0.5e-3;                             // m rms, of a picture
  double slowest = 0.3, fastest = 0.8;               // m/s, peak of the first movement
  double touch_slowest = 0.05, touch_fastest = 0.2;  // m/s
  double shortest_way = 0.16, longest_way = 0.20;    // m
};

struct IdealPrediction {
  Eigen::Vector2d place{kUnset, kUnset};  // best place of a prop for a touch at a given time; mean
  double within = 0.0;                    // probability of a touch within 2 mm of it, by the predictor itself
  double evidence = -HUGE_VAL;            // logarithm of the density of that time, without a common factor
};
// Uses the pictures that had arrived by `told`, for a tip that touches at `touches`, s.
[[nodiscard]] IdealPrediction ideal_place(const IdealSpec& spec, const SeenReach& reach, double told,
                                          double touches);

// Place of that predictor's prop at the touch, if an arm carries it: from rest, with each new picture,
// straight to the place that is then best, with at most this acceleration, m/s^2. It need not stop. For
// pictures far enough apart that it comes to rest between them, as at 20 Hz.
[[nodiscard]] Eigen::Vector2d ideal_carried(const IdealSpec& spec, const SeenReach& reach,
                                            double acceleration);

// Estimates of that predictor after a picture if it does not have the time of touch, as in practice: the
// place of touch for each possible time, and the probability of that time.
struct IdealCourse {
  static constexpr double kEach = 10e-3;  // s, from time to time
  double told = kUnset;                   // s, time of the picture
  std::vector<IdealPrediction> then;      // estimates from that time on; never empty
  // Mean of the estimates that are still ahead at a moment, weighted by their probability. Estimates within
  // `soon`, s, come first, because there is still time for later ones.
  [[nodiscard]] Eigen::Vector2d mean(double now, double soon) const;
};
// Estimates for the last pictures of a reach.
[[nodiscard]] std::vector<IdealCourse> ideal_courses(const IdealSpec& spec, const SeenReach& reach);

// Place of the prop at `met`, s, if an arm follows that mean as fast as this acceleration, m/s^2, allows,
// without any other delay.
[[nodiscard]] Eigen::Vector2d ideal_followed(const std::vector<IdealCourse>& courses, double met,
                                             double acceleration, double soon);

}  // namespace enc::bench::reaching
