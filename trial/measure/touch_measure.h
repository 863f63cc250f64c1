// Finds faulty touches: a contact without a touch, or an oscillation of machine and hand. It uses ground
// truth if every slot is simulated, otherwise the core's own data, so it works with real machines too.
//
// An oscillation of machine and hand against each other during a touch is a limit cycle of the loop, not the
// hand's own motion. If the tip moves by itself, force and depth change in opposite directions; if it gives
// way to a push, they change in one direction (core/control/task/admittance/damping.h).
#pragma once

#include <cmath>
#include <vector>

#include "core/control/scene/steadiness.h"
#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {

// Result of each press of a plan, by ground truth: whether it touched the prop, and whether the core
// recognised a contact.
//
// One press of the plan, from one approach to the next.
struct PressAttempt {
  double began = kUnset;      // s
  double touched = kUnset;    // s: first true contact; unset: no contact
  std::int32_t contacts = 0;  // contacts recognised by the core
  bool pressed = false;       // as deep as planned, or as long
  [[nodiscard]] bool missed() const { return pressed && std::isnan(touched); }
  [[nodiscard]] bool unnoticed() const { return pressed && !std::isnan(touched) && contacts == 0; }
};

class PlanMeasure {
 public:
  void see(const Glance& glance);
  // Excludes the reaches that turn back before a touch.
  [[nodiscard]] const std::vector<PressAttempt>& tried() const { return tried_; }

 private:
  void begin(const Glance& glance);

  std::vector<PressAttempt> tried_ = with_room<PressAttempt>();
  std::int32_t press_ = -1;    // index in the plan
  std::int32_t contacts_ = 0;  // the core's count before this tick
  bool tries_ = false;         // the press intends to touch
};

struct SwingFigures {
  double from = kUnset, until = kUnset;  // s
  double way = 0.0;                      // m, peak to peak, the widest
  double frequency = kUnset;             // Hz
  std::int32_t object = -1;
};

class TouchMeasure {
 public:
  static constexpr double kWay = Steadiness::kStill;  // m, peak to peak: smaller is not an oscillation
  static constexpr double kTime = 1.0;                // s, shortest duration, unless the contact ends before
  static constexpr double kLong =
      4.0;  // s: an oscillation that dies out sooner, in contact, is not a limit cycle
  static constexpr std::int64_t kTurns = 4;  // fewer turns are not an oscillation
  // N, force of an arm's law along the normal, mean over a contact. Dry friction of 0.01 N m in two joints,
  // 0.14 m from the tip, hides a smaller force. Derived.
  static constexpr double kHidden = 0.15;

  void see(const Glance& glance);
  [[nodiscard]] const std::vector<SwingFigures>& swings() const { return swings_; }
  // Time at which a limit of an arm's motors first acted for 20 ms, and the total time, s; unset: never.
  struct LimitAction {
    double first = kUnset, total = 0.0, now = 0.0;
  };
  [[nodiscard]] const LimitAction& peak() const { return peak_; }
  [[nodiscard]] const LimitAction& heat() const { return heat_; }
  // Begin of each contact in which nothing was touched, s.
  [[nodiscard]] const std::vector<double>& empty() const { return empty_; }
  [[nodiscard]] const PlanMeasure& plan() const { return plan_; }

 private:
  void see_motors(const Glance& glance);
  void see_contact(const Glance& glance);
  void end_contact(const Glance& glance);
  void see_swing(const Glance& glance);
  void filter_swing(const Glance& glance, double force);
  void end_swing(double t);
  void forget_swing();

  std::vector<SwingFigures> swings_ = with_room<SwingFigures>();
  std::vector<double> empty_ = with_room<double>();
  LimitAction peak_, heat_;
  PlanMeasure plan_;
  // A contact, as the core recognised it.
  struct Contact {
    std::int32_t number = 0;              // the core's number
    double began = kUnset, lasted = 0.0;  // s, without holds
    double pushed = 0.0;                  // N s, along the normal
    // True touch; touch by the force; the machine received commands.
    bool touched = false, felt = false, told = false;
  };
  Contact contact_;
  SwingFigures now_;
  bool touching_ = false, pressed_ = false;  // contact; pressed during the oscillation
  double away_ = kTime;                      // s
  Swing swing_;
  double last_move_ = 0.0;  // m
  std::int64_t turns_ = 0;  // since it began
};

}  // namespace enc::trial
