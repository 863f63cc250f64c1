#include "trial/measure/plan_measure.h"

namespace enc::trial {

// Waiting belongs to the press before.
void PlanMeasure::begin(const Glance& glance) {
  const sim::Truth& truth = glance.truth;
  if (truth.phase == sim::Phase::wait || truth.phase == sim::Phase::change || truth.press == press_) return;
  press_ = truth.press;
  tries_ = !truth.aborted;
  if (!tries_) return;
  tried_.emplace_back();
  tried_.back().began = seconds(truth.t.time_since_epoch());
}

void PlanMeasure::see(const Glance& glance) {
  const sim::Truth& truth = glance.truth;
  if (!glance.simulated || truth.press < 0) return;
  begin(glance);
  const std::int32_t more = glance.out.contacts - contacts_;
  contacts_ = glance.out.contacts;
  if (!tries_) return;
  Tried& now = tried_.back();
  now.contacts += more;
  now.pressed = now.pressed || truth.phase == sim::Phase::hold || truth.phase == sim::Phase::release ||
                truth.phase == sim::Phase::retreat;
  if (truth.touching && std::isnan(now.touched)) now.touched = seconds(truth.t.time_since_epoch());
}

}  // namespace enc::trial
