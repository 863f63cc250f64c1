// Evaluates the touches of a bare finger on an arm by ground truth: whether the prop was in place, and the
// force at each depth [VisHap 3].
#pragma once

#include <limits>
#include <vector>

#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {

// Straight line of force over depth.
struct LineFit {
  void add(double depth, double force);
  [[nodiscard]] double slope() const;  // N/m
  [[nodiscard]] double r2() const;     // share of the variance explained by the line
  std::int64_t n = 0;
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
};

// One approach, from the core's "prepare" to the end of the contact.
struct FingerEncounter {
  std::int32_t object = -1;
  double prepared = kUnset;        // s of experiment: away became follow
  double arrived = kUnset;         // s: from then on the prop is within 2 mm of the meeting point (Way)
  double touched = kUnset;         // s: first true contact with the prop
  double approach_speed = kUnset;  // m/s, planned
  // Distance from the prop's middle to the finger's lowest point, along the surface, at the touch, m.
  double miss = kUnset;
  double peak_force = 0.0;     // N, along the normal
  double peak_depth = kUnset;  // m, true; unset: no touch, or the object has moved
  double greatest_step = 0.0;  // N: largest change of the normal force in one tick, during the touch
  std::int32_t breaks = 0;     // ticks without contact between first and last
};

// Measures the arm's motion while the finger is far, and detects when the arm begins to prepare.
class FarWatch {
 public:
  bool see(const Glance& glance);  // true in the tick in which away becomes follow
  // Largest speed of the tip from a second after the mode became away, m/s.
  [[nodiscard]] double speed() const { return speed_; }

 private:
  Mode mode_ = Mode::away;
  double since_ = 0.0, speed_ = 0.0;
};

class FingerMeasure {
 public:
  void see(const Glance& glance);

  [[nodiscard]] const std::vector<FingerEncounter>& meetings() const { return meetings_; }
  [[nodiscard]] const LineFit& fit() const { return fit_; }  // force over the prop's depth of 2 to 10 mm
  // Line over the depth as the core estimated it.
  [[nodiscard]] const LineFit& believed() const { return believed_; }
  [[nodiscard]] double far_speed() const { return far_.speed(); }
  [[nodiscard]] double tangential_share() const;  // share of the normal force, while that is above 1 N

 private:
  void watch_meeting(const Glance& glance, double now);
  void watch_force(const Glance& glance);

  std::vector<FingerEncounter> meetings_ = with_room<FingerEncounter>();
  Way way_;  // path of the prop since the last "prepare"
  LineFit fit_, believed_;
  FarWatch far_;
  double last_force_ = kUnset;
  double tangential_ = 0.0, normal_ = 0.0;
};

// Ideal position of the prop for a finger at `tip`, and the surface normal there, by ground truth.
struct PropTarget {
  Point<'W'> point;
  Vec<'W'> normal;
  double distance = kUnset;  // distance of the tip's centre to the surface, m
};
[[nodiscard]] PropTarget wanted_at(const Object& object, const Point<'W'>& tip);

// Depth of a finger's nearest point below the surface of the core's chosen object, m, and that object's
// outward normal; by ground truth.
struct TrueDepth {
  double depth = kUnset;
  Vec<'W'> normal;
  Point<'W'> touching;  // the finger's nearest point
};
[[nodiscard]] TrueDepth true_depth(const Glance& glance);

}  // namespace enc::trial
