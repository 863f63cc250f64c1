#include "trial/ledger/ledger.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace enc::trial {
namespace {

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
