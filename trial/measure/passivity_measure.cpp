#include "trial/measure/passivity_measure.h"

#include <algorithm>
#include <cmath>

namespace enc::trial {

void PassivityMeasure::see(const Glance& glance) {
  const Passivity* now =
      glance.state != nullptr ? &recall<enc::Meeting>(*glance.state).tamed.energy : nullptr;
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
  contact.dissipated = now->dissipated;
  contact.most = std::max(contact.most, now->most);
  if ((glance.out.why & kPassive) != 0) contact.acted += glance.scene.dt;
}

PassivityFigures PassivityMeasure::worst() const {
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
