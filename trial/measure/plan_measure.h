// What became of each press of a plan, by the truth: did it touch the prop, and was it a contact to the core?
#pragma once

#include <cmath>
#include <vector>

#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {

// From one way there to the next.
struct Tried {
  double began = kUnset;      // s
  double touched = kUnset;    // s: first true contact; unset: none
  std::int32_t contacts = 0;  // to the core
  bool pressed = false;       // as deep as planned, or as long
  [[nodiscard]] bool missed() const { return pressed && std::isnan(touched); }
  [[nodiscard]] bool unnoticed() const { return pressed && !std::isnan(touched) && contacts == 0; }
};

class PlanMeasure {
 public:
  void see(const Glance& glance);
  // Without the reaches that turn back before they touch.
  [[nodiscard]] const std::vector<Tried>& tried() const { return tried_; }

 private:
  void begin(const Glance& glance);

  std::vector<Tried> tried_ = with_room<Tried>();
  std::int32_t press_ = -1;    // of the plan
  std::int32_t contacts_ = 0;  // before this tick
  bool tries_ = false;         // to touch
};

}  // namespace enc::trial
