// The energy of contacts: parts of the benchmark `ledger`.
#pragma once

#include "benchmarks/kit/kit.h"
#include "trial/ledger/ledger.h"

namespace enc::bench::ledger {

// J: what a tenth of a newton does over half a millimetre. Contacts whose largest term is less are judged by
// themselves.
inline constexpr double kSmallest = 0.05e-3;

// Adds the terms of a contact to those of others.
void add_terms(const trial::ContactLedger& one, trial::ContactLedger& all);

// Error against run time: what time step and integrator do to the energies of a scene's contacts.
void add_error_over_time(Bench& bench);

}  // namespace enc::bench::ledger
