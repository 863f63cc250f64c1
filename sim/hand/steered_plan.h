// A hand that is steered from outside, for instance by a mouse. The wanted position may jump; the hand
// follows at a person's speed. In contact it pushes along the surface's normal, as people do, unless it is
// dragged clearly sideways.
#pragma once

#include "core/base/frames.h"
#include "sim/hand/hand_plan.h"

namespace enc::sim {

struct SteeredPlan {
  static constexpr double kFastest = 0.5;     // m/s, speed of an unhurried reach (assumed)
  static constexpr double kQuickest = 8.0;    // m/s^2 (assumed: a reach of 0.2 m in 0.6 s)
  static constexpr double kRate = 20.0;       // rad/s: settles within 0.2 s (assumed)
  static constexpr double kStrongest = 15.0;  // N, most force in contact (assumed)
  // The contact has ended this far above the surface, or this long after the last touch: m, s.
  static constexpr double kLeft = 0.002, kApart = 0.05;
  bool on = false, touched = false;
  Point<'W'> to;                         // wanted position of the tip's centre
  Point<'W'> at;                         // present position of the plan
  Vec<'W'> velocity = Vec<'W'>::zero();  // m/s, rate of `at`
  Vec<'W'> beyond = Vec<'W'>::zero();    // m, aim of the arm beyond `at`, to push
  Point<'W'> anchor;                     // tip's centre at the touch
  Vec<'W'> normal = Vec<'W'>::zero();    // unit, outward normal of the surface there
  double apart = 0.0;                    // s since the last touch

  void steer(const Point<'W'>& place, const Point<'W'>& tip) {
    if (!on) at = tip;
    on = true;
    to = place;
  }
  void touch(const Point<'W'>& tip, const Vec<'W'>& normal_there) {
    touched = true;
    anchor = tip;
    normal = normal_there;
  }
  // Advances by h, s. In contact the hand pushes harder until `tip` is at the wanted position. `stiffness`:
  // the arm's, N/m; `integral_time`: of the rising push, s.
  HandPlan advance(double h, const Point<'W'>& tip, bool touching, double stiffness, double integral_time);

 private:
  [[nodiscard]] Vec3 meant() const;
};

}  // namespace enc::sim
