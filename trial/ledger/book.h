// The contacts of a run, as a machine's ledger weighs them: when one begins, when it ends, and when it has
// become another one. The ledger is that of an arm or of a hexapod, and says
//
//   Known                  all that the period from a tick on is counted with
//   tick(glance)           each tick; false where the scene has nothing that it weighs
//   rest(glance)           one at which nothing is touched
//   know(glance, was)      one at which something may be; `was`: at the last tick, if it was known
//   believed(mode)         the core takes it for a contact
//   rendered(now)          not of a real thing, which only its prop stands for
//   open(from)             a contact begins with what was known
//   count(was, now, work)  a period of it is over
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
  void see(const Glance& glance);  // each tick of a run that is simulated
  // Of one that lasts when the run ends, what it is by then.
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
  // What was touched on the way to a contact is none.
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
  std::optional<Known> before_;  // at the last tick
  bool on_ = false;
  ContactLedger mark_;   // which contact it is
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
