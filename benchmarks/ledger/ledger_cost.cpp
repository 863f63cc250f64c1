// Error against run time: the energies of a press, each term summed over the contacts.
#include "benchmarks/kit/force_precision.h"
#include "benchmarks/ledger/ledger.h"
#include "trial/ledger/ledger_measure.h"

namespace enc::bench::ledger {
namespace {

using C = trial::ContactLedger;
constexpr double C::*kTerms[] = {&C::hand,   &C::carried,      &C::kinetic, &C::spring,
                                 &C::weight, &C::joints,       &C::law,     &C::sampling,
                                 &C::delay,  &C::quantisation, &C::limits};
constexpr double kAccuracy = 0.005;  // of the largest term, chosen: half of what a ledger may be open

class Energies final : public trial::Quantities {
 public:
  Energies(const models::Setup& setup, trial::TrialOptions& options) : measure_(setup, options) {}
  void see(const trial::Glance& glance) override { measure_.see(glance); }
  [[nodiscard]] std::vector<double> all() const override {
    C sums;
    for (const C& one : measure_.contacts()) add_terms(one, sums);
    std::vector<double> terms;
    for (double C::*term : kTerms) terms.push_back(sums.*term);
    return terms;
  }

 private:
  trial::LedgerMeasure measure_;
};

}  // namespace

void add_terms(const C& one, C& all) {
  for (double C::*term : kTerms) all.*term += one.*term;
}

void add_error_over_time(Bench& bench) {
  PrecisionNorm norm{"a contact's energies", "%", 100.0, kAccuracy, {}};
  norm.quantities = [](const models::Setup& setup, trial::TrialOptions& options) {
    return std::make_unique<Energies>(setup, options);
  };
  add_force_precision(bench,
                      {"user.approach_mm_s=[50]", "user.approach_from_mm=20", "user.press_s=0.8",
                       "user.hold_s=0.2", "user.release_s=0.4", "user.rest_s=0.3"},
                      norm);
}

}  // namespace enc::bench::ledger
