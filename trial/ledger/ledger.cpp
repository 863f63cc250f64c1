#include "trial/ledger/ledger.h"

#include <algorithm>
#include <cmath>

namespace enc::trial {

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

}  // namespace enc::trial
