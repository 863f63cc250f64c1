// The energy ledger of every contact of a run, of whichever machine.
#pragma once

#include <optional>
#include <vector>

#include "trial/ledger/arm_ledger.h"
#include "trial/ledger/book.h"
#include "trial/ledger/hexapod_ledger.h"

namespace enc::trial {

class LedgerMeasure {
 public:
  // Of a run with these options, which it tells that the twin's work is asked for.
  LedgerMeasure(const models::Setup& setup, TrialOptions& options) {
    options.work = true;
    if (setup.scene.arm) arm_.emplace(ArmLedger(setup));
  }
  void see(const Glance& glance) {
    if (!glance.simulated) return;
    arm_ ? arm_->see(glance) : hexapod_.see(glance);
  }
  // While the trial lives whose objects they touch.
  [[nodiscard]] std::vector<ContactLedger> contacts() const {
    return arm_ ? arm_->contacts() : hexapod_.contacts();
  }

 private:
  std::optional<Book<ArmLedger>> arm_;
  Book<HexapodLedger> hexapod_{HexapodLedger{}};
};

}  // namespace enc::trial
