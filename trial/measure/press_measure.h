// Evaluates a press by ground truth: the encounter, the force against the reference at the true deflection,
// the energy.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "trial/lists/room.h"
#include "trial/measure/ideal_follower.h"
#include "trial/trial.h"

namespace enc::trial {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Distance from the deflection limit at which a press counts as having reached it, m: a hundredth of the
// limit and at most 0.05 mm, because a loop approaches the limit without reaching it (sources/hand 3).
[[nodiscard]] inline double near_limit(double limit) { return std::min(0.05e-3, 0.01 * limit); }

// One press of the user.
struct PressFigures {
  std::int32_t object = -1;        // object rendered last, index in the scene; -1: no object
  double limit = kUnset;           // m: deflection limit of the last contact
  double approach_speed = kUnset;  // m/s, planned
  double miss = kUnset;  // m: tool's touching point to the haptic-tip's, when the tool meets the surface
  // m, allowed by rig and hand: miss_bound(); for a drawn reach from the hand's own path, IdealFollower.
  double miss_bound = kUnset;
  double first_force_delay = kUnset;  // s from meeting the surface to the first true contact force
  double peak_force = 0.0;            // N, along the normal
  double peak_deflection = 0.0;       // m, true, at the haptic-tip's outermost point
  double over_limit = -kInfinite;     // m: largest true deflection minus the object's limit
  // N, when the true deflection first reaches the limit within near_limit().
  double force_at_limit = kUnset;
  // m: true tip to the buffered first-touch point, when the core reports it restored.
  double restore_error = kUnset;
  std::int32_t contacts = 0;  // contacts counted by the core
};

// A period in which the true force matches no force of the object at the true deflection, neither now nor
// shortly before.
struct Departure {
  double from = kUnset, lasted = 0.0;    // s
  double force = 0.0, deflection = 0.0;  // N, m, at the largest departure
  double away = 0.0;                     // N
  double impulse = 0.0;                  // N s, while the tip comes out of its inset
};

struct SquareMean {
  double sum = 0.0;
  std::int64_t n = 0;
  void add(double e) {
    sum += e * e;
    ++n;
  }
  [[nodiscard]] double root() const;
};

class PressMeasure {
 public:
  static constexpr double kOff = 0.5;      // N (docs/notes/encounter.md)
  static constexpr double kLasting = 0.5;  // s

  explicit PressMeasure(const models::Setup& setup);

  void see(const Glance& glance);

  [[nodiscard]] const std::vector<PressFigures>& presses() const { return presses_; }
  [[nodiscard]] double rmse_press() const { return press_error_.root(); }      // N
  [[nodiscard]] double rmse_release() const { return release_error_.root(); }  // N
  // Departures above kOff for longer than kLasting, or, while the tip comes out of its inset, of an equal
  // impulse.
  [[nodiscard]] const std::vector<Departure>& departures() const { return departures_; }
  [[nodiscard]] double energy_in() const { return energy_in_; }    // J, tool to tip
  [[nodiscard]] double energy_out() const { return energy_out_; }  // J, tip to tool
  // m, tip outside the undeformed object after it was inside; NaN: never inside.
  [[nodiscard]] double greatest_outside() const { return greatest_outside_; }
  [[nodiscard]] double greatest_tension() const { return greatest_tension_; }  // N, pull on the tool

 private:
  PressFigures* press_of(const sim::Truth& truth);
  void follow(const Glance& glance);
  void watch_outside(std::int32_t object, double deflection);
  void meet(const Glance& glance, PressFigures& press, const Vec3& normal, double tool_gap);
  void compare(const Glance& glance, PressFigures& press, const Object& object, double deflection,
               double force);
  void judge_law(const Glance& glance, const Object& object, double deflection, double force);

  const models::Setup& setup_;
  bool takes_force_, follows_;  // an arm; a hexapod whose hand has a drawn path
  // Followers of the point under the tool, on the hand's target object.
  std::array<IdealFollower, 2> followers_;
  std::vector<Departure> departures_ = with_room<Departure>();
  Departure off_;
  // N: range of the true force, now and as the filter still holds it.
  double least_ = 0.0, most_ = 0.0;
  std::vector<PressFigures> presses_ = with_room<PressFigures>();
  SquareMean press_error_, release_error_;
  double energy_in_ = 0.0, energy_out_ = 0.0, greatest_outside_ = kUnset, greatest_tension_ = 0.0;
  std::int32_t contacts_before_ = 0;
  Mode mode_before_ = Mode::away;
  Point<'W'> buffered_;
  double met_at_ = kUnset;  // s
  bool reached_ = false;
  std::int32_t object_before_ = -1;
  bool entered_ = false;  // the tip has been inside that object
};

// Largest distance of the tip from the tool when they meet at an approach speed, m, from the numbers of rig
// and twin alone: docs/notes/encounter.md.
[[nodiscard]] double miss_bound(const models::Setup& setup, double approach_speed);

// Delay of the machine's response to a force by the rig's model, s: filter, servo, dead time, two cycles.
[[nodiscard]] double response_lag(const RigSpec& rig);

// One run of the set-up, evaluated by a measure.
[[nodiscard]] PressMeasure measured_run(const models::Setup& setup, std::uint64_t seed, double& simulated);

}  // namespace enc::trial
