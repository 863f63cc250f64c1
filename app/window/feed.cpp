#include "app/window/feed.h"

#include <cmath>

#include "core/error.h"

namespace enc::app {
namespace {

// The component along the outward normal of the contact; 0 without a contact.
float along_normal(const State& state, const Vec<'W'>& force) {
  const Contact& contact = contact_of(state);
  if (!contact.X_WN.valid()) return 0.0F;
  return static_cast<float>(-dot(force, contact.X_WN * Vec<'N'>(0, 0, 1)));
}

float or_zero(double x) { return std::isfinite(x) ? static_cast<float>(x) : 0.0F; }

}  // namespace

Feed::Feed(trial::Trial& trial)
    : trial_(trial), front_(std::make_unique<Snapshot>()), back_(std::make_unique<Snapshot>()) {
  for (Snapshot* one : {front_.get(), back_.get()}) {
    one->data.reset(mj_makeData(trial.world().physics().model()));
    if (!one->data) throw Error("not enough memory for a window", {}, ErrorKind::device);
  }
}

void Feed::copy(const trial::Glance& glance) {
  sim::World& world = trial_.world();
  Snapshot& to = *back_;
  mjv_copyData(to.data.get(), world.physics().model(), world.physics().data());
  to.truth = glance.truth;
  to.state = *glance.state;
  to.out = glance.out;
  to.now = glance.tick;
  if (world.machine) to.platform = world.machine->state().pose;
  to.q_WT = world.q_WT();
  to.status = watch_.status();
  to.simulated = glance.simulated;
  to.truth.touching = to.truth.touching && glance.simulated;
}

void Feed::see(const trial::Glance& glance) {
  watch_.see(glance);
  if (ticks_++ % kSampleEach == 0) {
    const auto N_of = [](const Vec<'N'>& f) { return or_zero(-f.xyz[2]); };
    const bool touched = glance.out.mode == Mode::contact;
    samples_.push({static_cast<float>(seconds(glance.tick.t.time_since_epoch())),
                   touched ? or_zero(glance.out.felt.norm()) : 0.0F, touched ? N_of(glance.out.force) : 0.0F,
                   along_normal(*glance.state, glance.truth.contact_force),
                   touched ? or_zero(1e3 * glance.out.deflection) : 0.0F, or_zero(1e3 * glance.out.gap)});
  }
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || full_) return;
  copy(glance);
  full_ = true;
}

bool Feed::take() {
  const std::lock_guard lock(mutex_);
  if (!full_) return false;
  std::swap(front_, back_);
  full_ = false;
  return true;
}

Moment Feed::moment() {
  const sim::World& world = trial_.world();
  const Snapshot& s = *front_;
  return {trial_.setup(),
          trial_.scene(),
          trial_.world().physics().model(),
          s.data.get(),
          world.machine ? &world.machine->machine() : nullptr,
          world.pusher.has_value(),
          world.X_WR(),
          s.platform,
          s.q_WT,
          s.truth,
          s.state,
          s.out,
          s.now};
}

}  // namespace enc::app
