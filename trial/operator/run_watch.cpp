#include "trial/operator/run_watch.h"

namespace enc::trial {
void RunWatch::see(const Glance& glance) noexcept {
  if (glance.period_ns > 0) status_.periods_ns[status_.periods++ % RunStatus::kPeriods] = glance.period_ns;
  status_.t = glance.tick.t;
  status_.mode = glance.out.mode;
  status_.why = glance.out.why;
  status_.halted = glance.gate != nullptr && glance.gate->halted();
  status_.gap = glance.out.gap;
  status_.force = -glance.out.force.xyz[2];
  status_.missed += glance.in.missed;
  compare(glance);
  if (ticks_++ % kStatusEach == 0) statuses_.write(status_);
}

void RunWatch::compare(const Glance& glance) noexcept {
  using Kind = RunEvent::Kind;
  const Outputs& out = glance.out;
  const std::uint32_t why = out.mode == Mode::hold ? out.why & kHoldReasons : 0;
  if (glance.gate != nullptr) {
    each_role([&](const auto& role) {
      const bool lost = glance.gate->link_lost(role.id);
      bool& before = lost_[static_cast<std::size_t>(role.id)];
      if (lost && !before) push({Kind::link_lost, {}, 0, {}, 0, -1, role.name});
      before = lost;
    });
  }
  // An additional reason is an event; a reason that ends is not.
  if ((why & ~why_) != 0) push({Kind::hold, {}, why});
  if (why == 0 && why_ != 0) push({Kind::hold_over, {}, 0, out.mode});
  why_ = why;
  const bool in_contact = out.mode == Mode::contact || (in_contact_ && out.mode == Mode::hold);
  if (in_contact_ && !in_contact) push({Kind::contact_over, {}, 0, {}, contacts_, out.object});
  if (out.contacts > contacts_) push({Kind::contact, {}, 0, {}, out.contacts, out.object});
  contacts_ = out.contacts;
  in_contact_ = in_contact;
}

void RunWatch::note(RunEvent::Kind kind, int signal) noexcept {
  if (kind == RunEvent::Kind::resumed) lost_ = {};  // report a link that is still lost once more
  RunEvent event;
  event.kind = kind;
  event.signal = signal;
  push(event);
}

void RunWatch::push(RunEvent event) noexcept {
  event.t = status_.t;
  events_.push(event);
}

}  // namespace enc::trial
