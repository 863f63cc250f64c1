// What a bare finger met at an arm, judged by the truth: was the prop there, and what force was felt at which
// depth [VisHap 3].
#pragma once

#include <limits>
#include <vector>

#include "trial/lists/room.h"
#include "trial/lists/way.h"
#include "trial/trial.h"

namespace enc::trial {

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
  double arrived = kUnset;         // s: since then the prop has been within 2 mm of where they meet (Way)
  double touched = kUnset;         // s: first true contact with the prop
  double approach_speed = kUnset;  // m/s, planned
  double miss = kUnset;     // m: prop's middle to the finger's lowest point, along the surface, at the touch
  double peak_force = 0.0;  // N, along the normal
  double peak_depth = kUnset;  // m, true; unset: never touched, or a thing that has moved
  double greatest_step = 0.0;  // N: of the force along the normal from one tick to the next, while touched
  std::int32_t breaks = 0;     // ticks without contact between first and last
};

// How still the arm stands while the finger is far, and when it begins to prepare.
class FarWatch {
 public:
  bool see(const Glance& glance);  // true in the tick in which away becomes follow
  // Of the tip, at most, from a second after away began, m/s.
  [[nodiscard]] double speed() const { return speed_; }

 private:
  Mode mode_ = Mode::away;
  double since_ = 0.0, speed_ = 0.0;
};

class FingerMeasure {
 public:
  void see(const Glance& glance);

  [[nodiscard]] const std::vector<Meeting>& meetings() const { return meetings_; }
  [[nodiscard]] const LineFit& fit() const { return fit_; }            // over the true depth of 2 to 10 mm
  [[nodiscard]] const LineFit& believed() const { return believed_; }  // the same over what the core believed
  [[nodiscard]] double far_speed() const { return far_.speed(); }
  [[nodiscard]] double tangential_share() const;  // of the normal force, while more than 1 N is felt

 private:
  void watch_meeting(const Glance& glance, double now);
  void watch_force(const Glance& glance);

  std::vector<Meeting> meetings_ = with_room<Meeting>();
  Way way_;  // of the prop since the last "prepare"
  LineFit fit_, believed_;
  FarWatch far_;
  double last_force_ = kUnset;
  double tangential_ = 0.0, normal_ = 0.0;
};

// Where the prop should be when a finger is at `tip`, and the surface normal there. Of the truth.
struct Wanted {
  Point<'W'> point;
  Vec<'W'> normal;
  double distance = kUnset;  // of the tip's centre from the surface, m
};
[[nodiscard]] Wanted wanted_at(const Object& object, const Point<'W'>& tip);

// Depth of a finger's nearest point under the surface of the object that the core has chosen, m; and its
// outward normal. Of the truth.
struct TrueDepth {
  double depth = kUnset;
  Vec<'W'> normal;
  Point<'W'> touching;  // the finger's nearest point
};
[[nodiscard]] TrueDepth true_depth(const Glance& glance);

}  // namespace enc::trial
