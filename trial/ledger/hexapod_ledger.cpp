#include "trial/ledger/hexapod_ledger.h"

#include <algorithm>
#include <cmath>

#include "core/control/stages/step_context.h"
#include "core/control/task/tasks.h"

namespace enc::trial {
namespace {

// N: force of the object plus the force threshold.
double pushes_back(const Object& object, ResponseState& state, double depth, double threshold) {
  const double at = std::clamp(depth, 0.0, object.response.limit());
  const double force = object.response.force(state, at);
  return at > 0.0 ? force + threshold : 0.0;
}

// J, energy that the object would return from here on. The force stays constant beyond the object's limit.
double recoverable(const Object& object, ResponseState state, double depth, double threshold) {
  constexpr int kParts = 40;  // intervals of Simpson's rule, each with a middle point
  const double deepest = std::clamp(depth, 0.0, object.response.limit());
  const double part = deepest / kParts;
  double sum = threshold * deepest, force = object.response.force(state, deepest);
  sum += std::max(0.0, depth - deepest) * (force + threshold);
  for (int i = kParts - 1; i >= 0; --i) {
    const double middle = object.response.force(state, part * (i + 0.5));
    const double next = object.response.force(state, part * i);
    sum += part / 6.0 * (force + 4.0 * middle + next);
    force = next;
  }
  return sum;
}

}  // namespace

bool HexapodLedger::tick(const Glance& glance) {
  const AdmittanceTask* render = glance.scene.admittance();
  damped_ = render != nullptr && render->damping.has_value();
  return render != nullptr;
}

HexapodLedger::TickState HexapodLedger::know(const Glance& glance, const std::optional<TickState>& was) {
  TickState now;
  now.felt = glance.truth.contact_force.e();
  now.tip = glance.truth.tip.e();
  const AdmittanceState& rendering = recall<AdmittanceState>(*glance.state);
  const State& state = *glance.state;
  const Contact& contact = rendering.contact;
  const bool engaged = (state.mode == Mode::contact || state.mode == Mode::restore) && contact.object >= 0;
  const bool begins = engaged && object_ == nullptr;
  now.engaged = engaged;
  if (!engaged) {
    at_command_ = at_tip_ = ResponseState{};
    object_ = nullptr;
    if (was) now.normal = was->normal;
  } else {
    object_ = &glance.scene.objects[static_cast<std::size_t>(contact.object)];
    now.normal = contact.X_WN.q() * Vec3::UnitZ();
  }
  Forces& f = now.force;
  f.held = -now.normal.dot(glance.truth.contact_force.e());
  f.measured =
      glance.out.force_unfiltered.finite() ? -now.normal.dot(glance.out.force_unfiltered.e()) : f.held;
  f.filtered = state.force.finite() ? -now.normal.dot(state.force.e()) : f.measured;
  if (!engaged) return now;
  threshold_ = glance.scene.force.threshold;
  const auto depth_of = [&](const Vec3& at) {
    return -now.normal.dot(at - contact.X_WN.p()) - glance.scene.tip_radius - stages::kSkin;
  };
  ResponseState at_wanted = rendering.response;
  f.wanted = pushes_back(*object_, at_wanted, glance.out.deflection, threshold_);
  f.commanded =
      pushes_back(*object_, at_command_, depth_of((glance.scene.X_WR * rendering.command).e()), threshold_);
  now.depth = depth_ = depth_of(now.tip);
  f.ideal = pushes_back(*object_, at_tip_, depth_, threshold_);
  // A tip that waits inside the object has a loaded spring without any press.
  if (begins) loaded_ = recoverable(*object_, at_tip_, depth_, threshold_);
  return now;
}

// A pushing hand pushes against the normal: work is force outwards times motion inwards.
void HexapodLedger::count(const TickState& was, const TickState& now, const sim::Work& work) {
  const Forces& f = was.force;
  const double in = -was.normal.dot(now.tip - was.tip);
  const Vec3 aside = (now.tip - was.tip) + in * was.normal;
  sum_.hand += work.contact;
  sensed_ += work.sensed;
  across_ += aside.dot(now.felt);
  held_ += f.held * in;
  measured_ += f.measured * in;
  filtered_ += f.filtered * in;
  wanted_ += f.wanted * in;
  commanded_ += f.commanded * in;
  // A moving surface counts as carried work, as when the tip slides on a round one and its anchor moves
  // along.
  const double ideal = 0.5 * (f.ideal + now.force.ideal);
  const double pressed = was.engaged && now.engaged ? now.depth - was.depth : in;
  ideal_ += ideal * in;
  led_ += ideal * (in - pressed);
  if (!now.engaged) return;
  left_ =
      std::min(left_ + work.sensed - aside.dot(now.felt), recoverable(*object_, at_tip_, depth_, threshold_));
  sum_.surplus = std::max(sum_.surplus, -left_);
}

ContactLedger HexapodLedger::so_far(const TickState& /*last*/) const {
  ContactLedger sum = sum_;
  sum.spring = (object_ != nullptr ? recoverable(*object_, at_tip_, depth_, threshold_) : 0.0) - loaded_;
  sum.law = ideal_ - led_ - sum.spring;
  sum.carried = -across_ - led_;
  // A force that takes in more energy than the ideal one gives out less.
  sum.sampling = -(sensed_ - across_ - held_);
  sum.quantisation = -(held_ - measured_);
  sum.delay = -(measured_ - filtered_) - (commanded_ - ideal_);
  sum.limits = -(wanted_ - commanded_);
  (damped_ ? sum.law : sum.limits) += (damped_ ? 1.0 : -1.0) * (filtered_ - wanted_);
  return sum;
}

void HexapodLedger::open(const TickState& from) {
  if (from.engaged && object_ != nullptr) loaded_ = recoverable(*object_, at_tip_, depth_, threshold_);
  sum_ = ContactLedger{};
  left_ = led_ = sensed_ = across_ = held_ = measured_ = filtered_ = wanted_ = commanded_ = ideal_ = 0.0;
}

}  // namespace enc::trial
