// Plans of a hand: its intent at a time, the elements of its reaches, and a hand that is steered from
// outside.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/control/track/reach.h"

namespace enc::sim {

// The intent of a hand at a time, and the elements of its reaches: minimum-jerk submovements, which overlap
// and add up [Flash and Henis 1991; Milner 1992].
struct HandPlan {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(),
       acceleration = Vec3::Zero();  // motion of the tool's tip, in W
  double depth = 0.0;                // m, below the surface
  double load = 1.0;                 // share of the object's force that the person already pushes with
};

// A motion from rest to rest, by `way`.
struct Submovement {
  double start = 0.0, time = 1.0;  // s
  Vec<'W'> way = Vec<'W'>::zero();

  [[nodiscard]] double end() const { return start + time; }
  [[nodiscard]] double peak_speed() const { return 1.875 * way.norm() / time; }
  void add_to(HandPlan& plan, double t) const {
    const MinimumJerk m((t - start) / time);
    plan.position += m.x * way.e();
    plan.velocity += (m.v / time) * way.e();
    plan.acceleration += (m.a / (time * time)) * way.e();
  }
};

// A hand that is steered from outside, for instance by a mouse. The wanted position may jump; the hand
// follows at a person's speed. In contact it pushes along the surface's normal, as people do, unless it is
// dragged clearly sideways.
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

// The change of tools by a steered hand: it carries its tool to the tray, releases it, and takes the other
// one. Meanwhile it ignores its steering.
struct ToolChange {
  static constexpr double kSwap = 0.8;     // s with an empty hand, at least (as in a scripted change)
  static constexpr double kThere = 0.001;  // m from the place on the tray
  static constexpr double kRests = 0.02;   // m/s
  // State of the hand; away: on the way to the tray.
  enum class Stage : std::uint8_t { none, away, empty };
  Stage stage = Stage::none;
  std::int32_t from = 0;  // the released tool: 0 the first, 1 the other
  double since = 0.0;     // s since the hand became empty
  Point<'W'> wanted;      // target of the tip afterwards
};

}  // namespace enc::sim
