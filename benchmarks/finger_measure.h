// What a bare finger met at an arm, judged by the truth: was the prop there, and what force was felt at which
// depth [VisHap 3].
#pragma once

#include <limits>
#include <vector>

#include "benchmarks/trial.h"

namespace enc::bench {

// Straight line of force over depth.
struct LineFit {
  void add(double depth, double force);
  [[nodiscard]] double slope() const;  // N/m
  [[nodiscard]] double r2() const;     // share of the variance that the line explains
  std::int64_t n = 0;
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
};

// From the core's "prepare" to the end of the contact.
struct Meeting {
  std::int32_t object = -1;
  double prepared = kUnset;        // s of experiment: away became follow
  double arrived = kUnset;         // s: the prop was within 2 mm of where it was wanted, and stayed
  double touched = kUnset;         // s: first true contact with the prop
  double approach_speed = kUnset;  // m/s, planned
  double miss = kUnset;     // m: prop's middle to the finger's lowest point, along the surface, at the touch
  double peak_force = 0.0;  // N, along the normal
  double peak_depth = 0.0;  // m, true
  double greatest_step = 0.0;  // N: of the force along the normal from one tick to the next, while touched
  std::int32_t breaks = 0;     // ticks without contact between first and last
};

class FingerMeasure {
 public:
  void see(const Glance& glance);

  [[nodiscard]] const std::vector<Meeting>& meetings() const { return meetings_; }
  [[nodiscard]] const LineFit& fit() const { return fit_; }            // over the true depth of 2 to 10 mm
  [[nodiscard]] const LineFit& believed() const { return believed_; }  // the same over what the core believed
  [[nodiscard]] double far_speed() const {
    return far_speed_;
  }                                               // m/s, of the tip, at most, 1 s after away began
  [[nodiscard]] double tangential_share() const;  // of the normal force, while more than 1 N is felt

 private:
  void watch_meeting(const Glance& glance, double now);
  void watch_force(const Glance& glance);

  std::vector<Meeting> meetings_;
  LineFit fit_, believed_;
  Mode before_ = Mode::away;
  double away_since_ = 0.0, far_speed_ = 0.0, last_force_ = kUnset;
  double tangential_ = 0.0, normal_ = 0.0;
};

// Depth of a finger's nearest point under the surface of the object that the core has chosen, m; and its
// outward normal. Of the truth.
struct TrueDepth {
  double depth = kUnset;
  Vec<'W'> normal;
  Point<'W'> touching;  // the finger's nearest point
};
[[nodiscard]] TrueDepth true_depth(const Glance& glance);

}  // namespace enc::bench
