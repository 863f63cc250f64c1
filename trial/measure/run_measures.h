// All measures of `run`, together.
#pragma once

#include <algorithm>

#include "trial/ledger/ledger.h"
#include "trial/measure/finger_measure.h"
#include "trial/measure/passivity_measure.h"
#include "trial/measure/press_measure.h"
#include "trial/measure/programme_measures.h"
#include "trial/measure/seen_measure.h"
#include "trial/measure/touch_measure.h"
#include "trial/trial.h"

namespace enc::trial {

// The core's own data of a press, for runs without ground truth.
struct FeltMeasure {
  bool truth = true;     // every device is simulated: other measures are more accurate
  double peak = 0.0;     // N, along the normal, in contact
  double deepest = 0.0;  // m, as commanded

  void see(const Glance& glance) {
    truth = glance.simulated;
    if (glance.out.mode != Mode::contact) return;
    peak = std::max(peak, -glance.out.force.xyz[2]);
    deepest = std::max(deepest, glance.out.deflection);
  }
};

// Sets `watch` of these options, and must outlive the trial that uses them.
struct RunMeasures {
  RunMeasures(const models::Setup& setup, TrialOptions& options)
      : presses(setup), ledger(setup, options), meets_finger_(family_of(setup).takes_force) {
    options.watch = [this](const Glance& glance) { see(glance); };
  }
  RunMeasures(const RunMeasures&) = delete;
  RunMeasures& operator=(const RunMeasures&) = delete;

  void see(const Glance& glance) {
    presses.see(glance);
    felt.see(glance);
    pushes.see(glance);
    travel.see(glance);
    touches.see(glance);
    passivity.see(glance);
    ledger.see(glance);
    if (!meets_finger_) return;
    fingers.see(glance);
    seen.see(glance);
  }

  PressMeasure presses;
  FeltMeasure felt;
  ProbeMeasure pushes;
  TravelMeasure travel;
  FingerMeasure fingers;  // arm only
  TouchMeasure touches;
  SeenMeasure seen;  // arm only
  PassivityMeasure passivity;
  LedgerMeasure ledger;

 private:
  const bool meets_finger_;
};

}  // namespace enc::trial
