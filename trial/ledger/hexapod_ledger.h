// The ledger of a machine that takes positions and measures force. It cannot be driven back: what the hand
// does on its tip is taken by the servo, which gives it back where the law says so.
//
// The ideal: the object's response at the true depth of the tip, along its true way; behind a threshold the
// hand presses with that much more. From there the force that acts comes in parts, each the difference of two
// of these:
//
//   true          by the sensor as it is without any error
//   held          the true force of the tick                    true - held:       sampling
//   measured      counts, noise, zero                           held - measured:   quantisation
//   filtered      behind the low-pass                           measured - filtered: delay
//   wanted        of the object, where the law wants it         filtered - wanted: limits, or its damper
//   commanded     of the object, where the machine is sent      wanted - commanded: limits
//   ideal         of the object, where the tip is               commanded - ideal: delay
#pragma once

#include <vector>

#include "trial/ledger/ledger.h"
#include "trial/trial.h"

namespace enc::trial {

class HexapodLedger {
 public:
  void see(const Glance& glance);  // each tick of a run that is simulated
  // Of one that lasts when the run ends, what it is by then.
  [[nodiscard]] std::vector<ContactLedger> contacts() const;

 private:
  // N, outwards along the normal, at a tick and until the next.
  struct Forces {
    double held = 0.0, measured = 0.0, filtered = 0.0, wanted = 0.0, commanded = 0.0, ideal = 0.0;
  };
  struct Known {
    bool there = false;
    Vec3 normal = Vec3::UnitZ(), tip = Vec3::Zero(), felt = Vec3::Zero();  // felt: true, N
    Forces force;
  };
  [[nodiscard]] Known know(const Glance& glance);
  void count(const Known& now, const sim::Work& work);
  void close(double t);
  [[nodiscard]] ContactLedger so_far(double t) const;
  void forget();

  Known before_;
  bool on_ = false;
  ContactLedger sum_;
  double dt_ = kUnset, last_t_ = 0.0;  // s
  bool damped_ = false;
  double sensed_ = 0.0, across_ = 0.0;  // J, by the sensor; and of that, sideways
  double held_ = 0.0, measured_ = 0.0, filtered_ = 0.0, wanted_ = 0.0, commanded_ = 0.0, ideal_ = 0.0;  // J
  ResponseState at_command_, at_tip_;
  const Object* object_ = nullptr;
  double depth_ = 0.0, threshold_ = 0.0;  // m, N
  std::vector<ContactLedger> contacts_;
};

}  // namespace enc::trial
