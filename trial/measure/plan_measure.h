// Result of each press of a plan, by ground truth: whether it touched the prop, and whether the core
// recognised a contact.
#pragma once

#include <cmath>
#include <vector>

#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {

// One press of the plan, from one approach to the next.
struct Tried {
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
  [[nodiscard]] const std::vector<Tried>& tried() const { return tried_; }

 private:
  void begin(const Glance& glance);

  std::vector<Tried> tried_ = with_room<Tried>();
  std::int32_t press_ = -1;    // index in the plan
  std::int32_t contacts_ = 0;  // the core's count before this tick
  bool tries_ = false;         // the press intends to touch
};

}  // namespace enc::trial
