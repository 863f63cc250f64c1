// The energy balance of every contact of a run, for any machine.
#pragma once

#include <optional>
#include <vector>

#include "trial/ledger/arm_ledger.h"
#include "trial/ledger/book.h"
#include "trial/ledger/hexapod_ledger.h"

namespace enc::trial {

class LedgerMeasure {
 public:
  // Measures a run with these options, and requests the twin's work.
  LedgerMeasure(const models::Setup& setup, TrialOptions& options) {
    options.work = true;
    if (family_of(setup).takes_force) arm_.emplace(ArmLedger(setup));
  }
  void see(const Glance& glance) {
    if (!glance.simulated) return;
    arm_ ? arm_->see(glance) : hexapod_.see(glance);
  }
  // Call this while the trial that owns the objects is alive.
  [[nodiscard]] std::vector<ContactLedger> contacts() const {
    return arm_ ? arm_->contacts() : hexapod_.contacts();
  }

 private:
  std::optional<Book<ArmLedger>> arm_;
  Book<HexapodLedger> hexapod_{HexapodLedger{}};
};

}  // namespace enc::trial
