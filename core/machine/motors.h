// What an arm's motors give: for a moment their peak, for ever what their windings bear. Between the two the
// law folds back smoothly as a winding warms up; so the force keeps its direction.
#pragma once

#include "core/machine/arm.h"

namespace enc {

// How a motor gets warm.
struct Thermal {
  double winding_time = 12.0;   // s, of a winding against its housing (sources/arm 3, published)
  double housing_time = 612.0;  // s, and of the housing against the room (published)
  double winding_share =
      3.1 / (3.1 + 14.0);  // of the rise over the room that is over the housing (published)
};

// What the motors of an arm may give, as a rig file says it.
struct MotorRatings {
  double tip = 0.0;               // N: the tip nowhere pushes with more
  PerJoint peak{}, continuous{};  // of each motor, N m: for a moment, and for ever
  Thermal thermal{};
};

// Rise of each winding over its housing, and of that over the room, as shares of what a winding may have over
// the room for ever.
struct Heat {
  PerJoint winding{}, housing{};
  [[nodiscard]] double of(std::size_t joint) const { return winding[joint] + housing[joint]; }
};

// At this share of what it may have a winding begins to get less than its peak (assumed).
inline constexpr double kWarm = 0.8;

// Torque that a motor gives at a warmth: peak, then less, and at 1 what it bears for ever.
[[nodiscard]] double folded_back(double warmth, double peak, double continuous) noexcept;
// A tick under a load, which is the torque over the continuous one.
class Warming {
 public:
  Warming() = default;
  Warming(const Thermal& thermal, double dt);
  void operator()(double load, double& winding, double& housing) const noexcept;

 private:
  double winding_ = 0.0, housing_ = 0.0, share_ = 0.0;  // per tick, per tick, -
};
// The warmth from which on a motor gives no more than a torque that is between the two.
[[nodiscard]] double folds_at(double torque, double peak, double continuous) noexcept;
// s for which a cold motor bears a load until it is so warm; infinite: it never is.
[[nodiscard]] double bears_for(const Thermal& thermal, double load, double warmth);

// Which limit acts on a force.
enum class MotorLimit : std::uint8_t { none, peak, heat };

// The motors as the rig believes in them.
class Motors {
 public:
  Motors() = default;  // none: nothing is given
  Motors(const Arm& arm, const MotorRatings& ratings, double dt);

  // Largest share, 0 to 1, of joint torques `wanted` that there is beside `held`, which goes on.
  [[nodiscard]] double share(const Heat& heat, const PerJoint& held, const PerJoint& wanted,
                             MotorLimit& limit) const noexcept;
  void warm(Heat& heat, const PerJoint& torque) const noexcept;

  // N: what the tip can push with along `way` (unit) at joints q, beside gravity, at most the sheet's peak:
  // for a moment, and for ever.
  struct Strength {
    double peak = 0.0, lasting = 0.0;
  };
  [[nodiscard]] Strength strength(const Arm& arm, const PerJoint& q, const PerJoint& held,
                                  const Vec<'R'>& way) const noexcept;
  // s until the first of them, cold at first, gives less than that force; infinite: never.
  [[nodiscard]] double holds_for(const Arm& arm, const PerJoint& q, const PerJoint& held, const Vec<'R'>& way,
                                 double force) const;

  // The same of presses with pauses, in which gravity alone is held, s: the press in which a motor gives
  // less, 1 for the first; 0: none.
  struct Presses {
    double pressed = 0.0, pause = 0.0;  // s
    std::int64_t number = 1;
  };
  [[nodiscard]] std::int64_t gives_way_in(const Arm& arm, const PerJoint& q, const PerJoint& held,
                                          const Vec<'R'>& way, double force, const Presses& presses) const;

 private:
  std::size_t joints_ = 0;
  PerJoint peak_{}, continuous_{};  // at the joints, N m or N
  double tip_ = 0.0;                // N: nowhere more than this
  Thermal thermal_;
  Warming warming_;
};

}  // namespace enc
