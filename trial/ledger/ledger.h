// The energy balance of a contact: where the hand's work on the machine went, in J. It uses ground truth, so
// it exists only in simulation (docs/reference/ledger.md).
//
//   hand + carried + generated = stored + dissipated,   generated = sampling + delay + quantisation + limits
//
// The left side is the energy put in: by the hand, by the moving target of the law, and by deviations from
// the law's force (held for a period, late, counted, limited). `hand` is measured on the pushing body,
// everything else on the machine and its law. So the residual is an error of the balance or of the physics.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trial/trial.h"

namespace enc::trial {

struct ContactLedger {
  std::int32_t contact = 0;         // the core's number, from 1
  std::int32_t object = -1;         // index in the scene
  double began = 0.0, ended = 0.0;  // s
  bool rendered = true;             // false: a real object, for which only its prop stands
  double hand = 0.0;                // work on the machine by the pushing body
  double carried = 0.0;             // work of the moving target and surface of the law
  double kinetic = 0.0, spring = 0.0,
         weight = 0.0;             // Increase from begin to end; weight: uncompensated.
  double joints = 0.0, law = 0.0;  // taken by the machine's friction; by damper or hysteresis
  double sampling = 0.0, delay = 0.0, quantisation = 0.0, limits = 0.0;  // positive: energy given out
  // Largest deficit at any moment: energy given out beyond the energy put in and still in the law's spring.
  // For an arm, against its target, from the touch on; for a hexapod, along the normal.
  double surplus = 0.0;

  [[nodiscard]] double stored() const { return kinetic + spring + weight; }
  [[nodiscard]] double dissipated() const { return joints + law; }
  [[nodiscard]] double generated() const { return sampling + delay + quantisation + limits; }
  [[nodiscard]] double left_over() const { return hand + carried + generated() - stored() - dissipated(); }
  [[nodiscard]] double largest() const;  // largest of the terms in the balance and of their parts
  // Residual as a share of the largest term; 0 if all are 0.
  [[nodiscard]] double closure() const;
};

// The contacts of a run with their balances, on one family of machines.
class Balance {
 public:
  virtual ~Balance() = default;
  virtual void see(const Glance& glance) = 0;  // call at each tick of a simulated run
  // The terms of a contact that lasts at the end of the run cover the time up to then.
  [[nodiscard]] virtual std::vector<ContactLedger> contacts() const = 0;
};

// The energy balance of every contact of a run, for any machine.
class LedgerMeasure {
 public:
  // Measures a run with these options, and requests the twin's work.
  LedgerMeasure(const models::Setup& setup, TrialOptions& options);
  void see(const Glance& glance) {
    if (glance.simulated) balance_->see(glance);
  }
  // Call this while the trial that owns the objects is alive.
  [[nodiscard]] std::vector<ContactLedger> contacts() const { return balance_->contacts(); }

 private:
  std::unique_ptr<Balance> balance_;
};

// Largest surplus among the contacts that were pushed, J; without a push, no hand feels it.
[[nodiscard]] double worst_surplus(const std::vector<ContactLedger>& contacts);

// A term of the balance; its name includes the unit.
struct LedgerTerm {
  const char* name;
  double (*of)(const ContactLedger&);
};
[[nodiscard]] std::span<const LedgerTerm> ledger_terms();
// CSV: one row for each contact.
[[nodiscard]] std::string ledger_table(const std::vector<ContactLedger>& contacts);

}  // namespace enc::trial
