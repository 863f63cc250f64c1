// What was wrong with a touch, by what the core itself knows, so that it sees real machines, too: nothing was
// felt in it; or machine and hand swung.
//
// Whether machine and hand swing against each other while they touch: a limit cycle of the loop, not what the
// hand does. Where the tip moves by itself force and depth change in opposite ways; where it gives in to a
// push they change alike (core/damping.h).
#pragma once

#include <vector>

#include "core/steadiness.h"
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
  static constexpr double kLong = 4.0;  // s: who dies out sooner, in contact, was no limit cycle

  void see(const Glance& glance);
  [[nodiscard]] const std::vector<SwingFigures>& swings() const { return swings_; }
  // When a limit of an arm's motors first acted for 20 ms, and for how long in all, s; unset: never.
  struct Acted {
    double first = kUnset, total = 0.0, now = 0.0;
  };
  [[nodiscard]] const Acted& peak() const { return peak_; }
  [[nodiscard]] const Acted& heat() const { return heat_; }
  // When each contact began in which the force never was one, s.
  [[nodiscard]] const std::vector<double>& empty() const { return empty_; }

 private:
  void see_motors(const Glance& glance);
  void see_force(const Glance& glance);
  void see_swing(const Glance& glance);

  std::vector<SwingFigures> swings_;
  std::vector<double> empty_;
  Acted peak_, heat_;
  SwingFigures now_;
  bool touching_ = false, felt_ = false;
  double began_ = kUnset, away_ = kTime;  // s
  Swing swing_;
  double last_move_ = 0.0;  // m
  std::int64_t turns_ = 0;  // zero crossings since it began
};

}  // namespace enc::trial
