#include "trial/ledger/ledger.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "trial/ledger/arm_ledger.h"
#include "trial/ledger/hexapod_ledger.h"

namespace enc::trial {
namespace {

// The contacts of a run for an energy balance: each contact's begin and end, and its change into another
// contact. `Ledger` is that of an arm or of a hexapod, and provides
//
//   TickState              all values needed for the period that begins at a tick
//   tick(glance)           called each tick; false if the scene has no balance of this kind
//   rest(glance)           called at a tick without a touch
//   know(glance, was)      values at a tick that may have a touch; `was`: those of the last tick, if known
//   believed(mode)         true if the core takes it for a contact
//   rendered(now)          false for a real object, for which only its prop stands
//   open(from)             starts a contact with the known values
//   count(was, now, work)  adds a period of it
//   so_far(last)           its terms
template <class Ledger>
class Book final : public Balance {
 public:
  explicit Book(Ledger ledger) : ledger_(std::move(ledger)) {}
  void see(const Glance& glance) override;
  [[nodiscard]] std::vector<ContactLedger> contacts() const override {
    std::vector<ContactLedger> all = closed_;
    if (on_ && mark_.contact != 0) all.push_back(so_far(last_t_));
    return all;
  }

 private:
  using TickState = typename Ledger::TickState;
  void open(const TickState& from, double t) {
    on_ = true;
    mark_ = ContactLedger{};
    mark_.began = t;
    ledger_.open(from);
  }
  // A touch that does not become a contact does not count.
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
  std::optional<TickState> before_;  // values of the last tick
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
  const TickState now = ledger_.know(glance, before_);
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

using C = ContactLedger;
constexpr std::array kTerms{
    LedgerTerm{"began_s", [](const C& c) { return c.began; }},
    LedgerTerm{"ended_s", [](const C& c) { return c.ended; }},
    LedgerTerm{"hand_mJ", [](const C& c) { return c.hand * 1e3; }},
    LedgerTerm{"carried_mJ", [](const C& c) { return c.carried * 1e3; }},
    LedgerTerm{"stored_mJ", [](const C& c) { return c.stored() * 1e3; }},
    LedgerTerm{"dissipated_mJ", [](const C& c) { return c.dissipated() * 1e3; }},
    LedgerTerm{"generated_mJ", [](const C& c) { return c.generated() * 1e3; }},
    LedgerTerm{"sampling_mJ", [](const C& c) { return c.sampling * 1e3; }},
    LedgerTerm{"delay_mJ", [](const C& c) { return c.delay * 1e3; }},
    LedgerTerm{"quantisation_mJ", [](const C& c) { return c.quantisation * 1e3; }},
    LedgerTerm{"limits_mJ", [](const C& c) { return c.limits * 1e3; }},
    LedgerTerm{"kinetic_mJ", [](const C& c) { return c.kinetic * 1e3; }},
    LedgerTerm{"spring_mJ", [](const C& c) { return c.spring * 1e3; }},
    LedgerTerm{"weight_mJ", [](const C& c) { return c.weight * 1e3; }},
    LedgerTerm{"joints_mJ", [](const C& c) { return c.joints * 1e3; }},
    LedgerTerm{"law_mJ", [](const C& c) { return c.law * 1e3; }},
    LedgerTerm{"surplus_mJ", [](const C& c) { return c.surplus * 1e3; }},
    LedgerTerm{"left_over_mJ", [](const C& c) { return c.left_over() * 1e3; }},
    LedgerTerm{"closure_percent", [](const C& c) { return c.closure() * 100.0; }},
};

}  // namespace

double ContactLedger::largest() const {
  double most = 0.0;
  for (const double term : {hand, carried, stored(), dissipated(), sampling, delay, quantisation, limits})
    most = std::max(most, std::abs(term));
  return most;
}

double ContactLedger::closure() const {
  const double most = largest();
  return most > 0.0 ? std::abs(left_over()) / most : 0.0;
}

LedgerMeasure::LedgerMeasure(const models::Setup& setup, TrialOptions& options) {
  options.work = true;
  if (family_of(setup).takes_force)
    balance_ = std::make_unique<Book<ArmLedger>>(ArmLedger(setup));
  else
    balance_ = std::make_unique<Book<HexapodLedger>>(HexapodLedger{});
}

double worst_surplus(const std::vector<ContactLedger>& contacts) {
  double most = 0.0;
  for (const ContactLedger& one : contacts)
    if (one.hand != 0.0) most = std::max(most, one.surplus);
  return most;
}

std::span<const LedgerTerm> ledger_terms() { return kTerms; }

std::string ledger_table(const std::vector<ContactLedger>& contacts) {
  std::string text = "contact,object,rendered";
  for (const LedgerTerm& term : kTerms) text += fmt::format(",{}", term.name);
  text += '\n';
  for (const ContactLedger& one : contacts) {
    text += fmt::format("{},{},{}", one.contact, one.object, one.rendered ? 1 : 0);
    for (const LedgerTerm& term : kTerms) text += fmt::format(",{}", term.of(one));
    text += '\n';
  }
  return text;
}

}  // namespace enc::trial
