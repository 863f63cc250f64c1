// What an ideal predictor could do with the pictures of a reach: an upper bound for the prop's being there in
// time. It knows what no machine can, the very numbers of the simulated person and when the finger touches,
// tries every timing finely, and its prop is anywhere at once or is carried by an arm.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/frames.h"
#include "sim/spec/twin_spec.h"

namespace enc::bench::reaching {

// What was seen of a reach for a plane until it was met, in axes whose z is the plane's normal, 0 where the
// tip touches.
struct SeenReach {
  struct Picture {
    Vec3 at{kUnset, kUnset, kUnset};         // m
    double exposed = kUnset, told = kUnset;  // s
  };
  std::vector<Picture> pictures;          // in the order of time
  double met = kUnset;                    // s
  Eigen::Vector2d where{kUnset, kUnset};  // x and y of the tip then
};

struct IdealSpec {
  sim::HandTruth hand;
  double noise = 0.5e-3;                             // m rms, of a picture
  double slowest = 0.3, fastest = 0.8;               // m/s, peak of the first movement
  double touch_slowest = 0.05, touch_fastest = 0.2;  // m/s
  double shortest_way = 0.16, longest_way = 0.20;    // m
};

struct Ideal {
  Eigen::Vector2d place{kUnset, kUnset};  // at which a prop is best, if the tip touches at a time; mean
  double within = 0.0;  // probability of the tip's touching within 2 mm of it, as the predictor itself thinks
  double evidence = -HUGE_VAL;  // logarithm of the density of that time; but for what all times share
};
// By the pictures that were told by `told`, of a tip that touches at `touches`, s.
[[nodiscard]] Ideal ideal_place(const IdealSpec& spec, const SeenReach& reach, double told, double touches);

// Where the prop of that predictor is when the finger touches, if an arm carries it: from rest, with each new
// picture, straight to the place that is best by then, with at most this acceleration, m/s^2. It need not
// stop. For pictures that are so far apart that it comes to rest between them, as at 20 Hz.
[[nodiscard]] Eigen::Vector2d ideal_carried(const IdealSpec& spec, const SeenReach& reach,
                                            double acceleration);

// What that predictor knows by a picture if nobody tells it when the finger touches, as nobody does: where it
// would touch, were it so long after, and how probable each time is.
struct IdealCourse {
  static constexpr double kEach = 10e-3;  // s, from time to time
  double told = kUnset;                   // s, when the picture was
  std::vector<Ideal> then;                // from that on; never empty
  // Mean of what is still to come at a moment, weighted by how probable it is; what comes within `soon`, s,
  // before the rest, because what comes later can still be met later.
  [[nodiscard]] Eigen::Vector2d mean(double now, double soon) const;
};
// Of the last pictures of a reach.
[[nodiscard]] std::vector<IdealCourse> ideal_courses(const IdealSpec& spec, const SeenReach& reach);

// Where the prop is at `met`, s, if an arm goes after that mean as soon as this acceleration, m/s^2, allows,
// and does nothing else late.
[[nodiscard]] Eigen::Vector2d ideal_followed(const std::vector<IdealCourse>& courses, double met,
                                             double acceleration, double soon);

}  // namespace enc::bench::reaching
