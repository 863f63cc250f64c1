// Results of the passivity controller for each contact (core/control/safety/passivity).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {

struct PassivityFigures {
  double began = kUnset;  // s
  double given = 0.0;     // J, largest observed energy given out beyond the energy put in
  // Extra energy that the unreduced law would have given out, J; NaN without a reduction of force.
  double dissipated = 0.0;
  double most = 0.0;         // N, largest reduction of the push; NaN without a reduction of force
  double acted = 0.0;        // s, time in which it acted
  std::int32_t contact = 0;  // the core's number
};

// True if the rig asks for a passivity controller.
[[nodiscard]] inline bool controlled(const Scene& scene) {
  return family_of(scene).passivity_form(scene) != PassivityForm::none;
}

class PassivityMeasure {
 public:
  void see(const Glance& glance);
  // Figures up to the last tick of each contact. Empty without a passivity controller.
  [[nodiscard]] const std::vector<PassivityFigures>& contacts() const { return contacts_; }
  [[nodiscard]] PassivityFigures worst() const;  // largest of each; `dissipated` and `acted` are totals

 private:
  std::vector<PassivityFigures> contacts_ = with_room<PassivityFigures>();
  bool on_ = false;
};

inline void PassivityMeasure::see(const Glance& glance) {
  const Passivity* now = glance.state != nullptr ? &glance.family.passivity(*glance.state) : nullptr;
  const bool on = now != nullptr && now->on;
  if (on && (!on_ || contacts_.back().contact != glance.out.contacts)) {
    PassivityFigures& begun = contacts_.emplace_back();
    begun.began = seconds(glance.tick.t.time_since_epoch());
    begun.contact = glance.out.contacts;
  }
  on_ = on;
  if (!on) return;
  PassivityFigures& contact = contacts_.back();
  contact.given = std::max(contact.given, now->given);
  const bool force = glance.family.takes_force;
  contact.dissipated = force ? now->dissipated : kUnset;
  contact.most = force ? std::max(contact.most, now->most) : kUnset;
  if ((glance.out.why & kPassive) != 0) contact.acted += glance.scene.dt;
}

inline PassivityFigures PassivityMeasure::worst() const {
  PassivityFigures all;
  for (const PassivityFigures& contact : contacts_) {
    if (std::isnan(all.began)) all.began = contact.began;
    all.given = std::max(all.given, contact.given);
    all.dissipated += contact.dissipated;
    all.most = std::max(all.most, contact.most);
    all.acted += contact.acted;
  }
  return all;
}

}  // namespace enc::trial
