// What was wrong with a touch: nothing was touched in it; or machine and hand swung. Judged by the truth
// where every slot is simulated, else by what the core itself knows, so that it sees real machines, too.
//
// Whether machine and hand swing against each other while they touch: a limit cycle of the loop, not what the
// hand does. Where the tip moves by itself force and depth change in opposite ways; where it gives in to a
// push they change alike (core/control/task/render/damping.h).
#pragma once

#include <vector>

#include "core/control/scene/steadiness.h"
#include "trial/lists/room.h"
#include "trial/measure/plan_measure.h"
#include "trial/trial.h"

namespace enc::trial {

struct SwingFigures {
  double from = kUnset, until = kUnset;  // s
  double way = 0.0;                      // m, peak to peak, the widest
  double frequency = kUnset;             // Hz
  std::int32_t object = -1;
};

class TouchMeasure {
 public:
  static constexpr double kWay = Steadiness::kStill;  // m, peak to peak: less is no swing
  static constexpr double kTime = 1.0;                // s, for which it goes on, or until the contact is over
  static constexpr double kLong = 4.0;       // s: who dies out sooner, in contact, was no limit cycle
  static constexpr std::int64_t kTurns = 4;  // fewer are no swing
  // N, of an arm's law along the normal, mean of a contact: dry friction of 0.01 N m in two joints, 0.14 m
  // from the tip, hides less. Derived.
  static constexpr double kHidden = 0.15;

  void see(const Glance& glance);
  [[nodiscard]] const std::vector<SwingFigures>& swings() const { return swings_; }
  // When a limit of an arm's motors first acted for 20 ms, and for how long in all, s; unset: never.
  struct Acted {
    double first = kUnset, total = 0.0, now = 0.0;
  };
  [[nodiscard]] const Acted& peak() const { return peak_; }
  [[nodiscard]] const Acted& heat() const { return heat_; }
  // When each contact began in which nothing was touched, s.
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
  Acted peak_, heat_;
  PlanMeasure plan_;
  // A contact, by the core.
  struct Contact {
    std::int32_t number = 0;                           // to the core
    double began = kUnset, lasted = 0.0;               // s, without what was a hold
    double pushed = 0.0;                               // N s, along the normal
    bool touched = false, felt = false, told = false;  // truly; by the force; the machine was told
  };
  Contact contact_;
  SwingFigures now_;
  bool touching_ = false, pressed_ = false;  // in contact; felt while it swings
  double away_ = kTime;                      // s
  Swing swing_;
  double last_move_ = 0.0;  // m
  std::int64_t turns_ = 0;  // since it began
};

}  // namespace enc::trial
