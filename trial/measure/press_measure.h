// What a press was, judged by the truth: the encounter, the force against the reference at the true
// deflection, the energy.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "trial/lists/room.h"
#include "trial/travel/ideal_follower.h"
#include "trial/trial.h"

namespace enc::trial {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

// So near to its deflection limit, m, a press has reached it: a hundredth of it and at most 0.05 mm, because
// a loop approaches the limit and does not meet it (sources/hand 3).
[[nodiscard]] inline double near_limit(double limit) { return std::min(0.05e-3, 0.01 * limit); }

// One press of the user.
struct PressFigures {
  std::int32_t object = -1;        // that the core rendered last, index in the scene; -1: none
  double limit = kUnset;           // m: deflection limit of the last contact
  double approach_speed = kUnset;  // m/s, planned
  double miss = kUnset;  // m: touching point of the tool's tip to that of the haptic-tip, when the tool meets
                         // the surface
  // m: what rig and hand allow: miss_bound(); of a drawn reach by the hand's own path, IdealFollower
  double miss_bound = kUnset;
  double first_force_delay = kUnset;  // s from meeting the surface to the first true contact force
  double peak_force = 0.0;            // N, along the normal
  double peak_deflection = 0.0;       // m, true, of the haptic-tip's outermost point
  double over_limit = -kInfinite;     // m: the largest of true deflection less the object's limit
  double force_at_limit =
      kUnset;  // N, when the true deflection first reaches the limit, but for near_limit()
  double restore_error =
      kUnset;  // m: true tip to the buffered first-touch point, when the core calls it restored
  std::int32_t contacts = 0;  // contact events of the core
};

// The true force was none that the object pushes back with at the true deflection, nor has been lately.
struct Departure {
  double from = kUnset, lasted = 0.0;    // s
  double force = 0.0, deflection = 0.0;  // N, m: where it was farthest
  double away = 0.0;                     // N
  double impulse = 0.0;                  // N s, of a tip that comes out of its inset
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
  // More than kOff for longer than kLasting, or, while the tip comes out of its inset, of as large an
  // impulse.
  [[nodiscard]] const std::vector<Departure>& departures() const { return departures_; }
  [[nodiscard]] double energy_in() const { return energy_in_; }    // J, tool to tip
  [[nodiscard]] double energy_out() const { return energy_out_; }  // J, tip to tool
  [[nodiscard]] double greatest_outside() const {
    return greatest_outside_;
  }  // m, of the tip outside the undeformed object, once it has been inside; NaN: it never was
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
  std::array<IdealFollower, 2>
      followers_;  // of the point under the tool, on the object that the hand reaches for
  std::vector<Departure> departures_ = with_room<Departure>();
  Departure off_;
  double least_ = 0.0, most_ = 0.0;  // N: true force, of now and as the filter still holds it
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

// How far the tip may be from the tool when it is met at an approach speed, from the numbers of rig and twin
// alone, m: docs/notes/encounter.md.
[[nodiscard]] double miss_bound(const models::Setup& setup, double approach_speed);

// By how much the machine answers late to a force, as the rig believes, s: filter, servo, dead time, two
// cycles.
[[nodiscard]] double response_lag(const RigSpec& rig);

// One run of the set-up, looked on by a measure.
[[nodiscard]] PressMeasure measured_run(const models::Setup& setup, std::uint64_t seed, double& simulated);

}  // namespace enc::trial
