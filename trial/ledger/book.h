// The contacts of a run for an energy balance: each contact's begin and end, and its change into another
// contact. `Ledger` is that of an arm or of a hexapod, and provides
//
//   Known                  all values needed for the period that begins at a tick
//   tick(glance)           called each tick; false if the scene has no balance of this kind
//   rest(glance)           called at a tick without a touch
//   know(glance, was)      values at a tick that may have a touch; `was`: those of the last tick, if known
//   believed(mode)         true if the core takes it for a contact
//   rendered(now)          false for a real object, for which only its prop stands
//   open(from)             starts a contact with the known values
//   count(was, now, work)  adds a period of it
//   so_far(last)           its terms
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "trial/ledger/ledger.h"
#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {

template <class Ledger>
class Book {
 public:
  explicit Book(Ledger ledger) : ledger_(std::move(ledger)) {}
  void see(const Glance& glance);  // call at each tick of a simulated run
  // A contact that lasts at the end of the run has its terms up to then.
  [[nodiscard]] std::vector<ContactLedger> contacts() const {
    std::vector<ContactLedger> all = closed_;
    if (on_ && mark_.contact != 0) all.push_back(so_far(last_t_));
    return all;
  }

 private:
  using Known = typename Ledger::Known;
  void open(const Known& from, double t) {
    on_ = true;
    mark_ = ContactLedger{};
    mark_.began = t;
    ledger_.open(from);
  }
  // A touch on the way to a contact does not count as a contact.
  void close(double t) {
    on_ = false;
    if (mark_.contact != 0) closed_.push_back(so_far(t));
  }
  [[nodiscard]] ContactLedger so_far(double t) const {
    ContactLedger sum = ledger_.so_far(*before_);
    sum.contact = mark_.contact;
    sum.object = mark_.object;
    sum.rendered = mark_.rendered;
    sum.began = mark_.began;
    sum.ended = t;
    return sum;
  }

  Ledger ledger_;
  std::optional<Known> before_;  // values of the last tick
  bool on_ = false;
  ContactLedger mark_;   // identifies the present contact
  double last_t_ = 0.0;  // s
  std::vector<ContactLedger> closed_ = with_room<ContactLedger>();
};

template <class Ledger>
void Book<Ledger>::see(const Glance& glance) {
  if (glance.state == nullptr || !ledger_.tick(glance)) return;
  const bool contact = Ledger::believed(glance.out.mode);
  const bool touched = contact || glance.truth.touching;
  const double t = seconds(glance.tick.t.time_since_epoch());
  if (!touched && !on_ && glance.state->mode == Mode::away) {
    before_.reset();
    ledger_.rest(glance);
    return;
  }
  const Known now = ledger_.know(glance, before_);
  const bool again = on_ && contact && mark_.contact != 0 && mark_.contact != glance.out.contacts;
  if (touched && !on_) open(before_ ? *before_ : now, before_ ? t - glance.scene.dt : t);
  if (on_ && before_) ledger_.count(*before_, now, glance.truth.work);
  before_ = now;
  if (again) {
    close(t);
    open(now, t);
  }
  if (on_ && contact) {
    mark_.contact = glance.out.contacts;
    mark_.object = glance.out.object;
    mark_.rendered = Ledger::rendered(now);
  }
  if (on_ && !touched) close(t);
  if (on_) last_t_ = t;
}

}  // namespace enc::trial
