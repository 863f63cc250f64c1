// The energy ledger of every contact of a run, of whichever machine.
#pragma once

#include <optional>
#include <vector>

#include "trial/ledger/arm_ledger.h"

namespace enc::trial {

class LedgerMeasure {
 public:
  explicit LedgerMeasure(const models::Setup& setup) {
    if (setup.scene.arm) arm_.emplace(setup);
  }
  void see(const Glance& glance) {
    if (!glance.simulated) return;
    if (arm_) arm_->see(glance);
  }
  [[nodiscard]] std::vector<ContactLedger> contacts() const {
    if (arm_) return arm_->contacts();
    return {};
  }

 private:
  std::optional<ArmLedger> arm_;
};

}  // namespace enc::trial
