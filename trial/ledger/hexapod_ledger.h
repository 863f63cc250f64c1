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

#include <optional>

#include "trial/ledger/ledger.h"
#include "trial/trial.h"

namespace enc::trial {

class HexapodLedger {
 public:
  // N, outwards along the normal, at a tick and until the next.
  struct Forces {
    double held = 0.0, measured = 0.0, filtered = 0.0, wanted = 0.0, commanded = 0.0, ideal = 0.0;
  };
  struct Known {
    Vec3 normal = Vec3::UnitZ(), tip = Vec3::Zero(), felt = Vec3::Zero();  // felt: true, N
    Forces force;
    double depth = 0.0;    // m, of the tip in the object
    bool engaged = false;  // the object is rendered
  };

  // As Book asks.
  [[nodiscard]] bool tick(const Glance& glance);
  void rest(const Glance& /*glance*/) {}
  [[nodiscard]] Known know(const Glance& glance, const std::optional<Known>& was);
  [[nodiscard]] static bool believed(Mode mode) { return mode == Mode::contact || mode == Mode::restore; }
  [[nodiscard]] static bool rendered(const Known& /*now*/) { return true; }
  void open(const Known& from);
  void count(const Known& was, const Known& now, const sim::Work& work);
  [[nodiscard]] ContactLedger so_far(const Known& last) const;

 private:
  ContactLedger sum_;
  bool damped_ = false;
  double sensed_ = 0.0, across_ = 0.0;  // J, by the sensor; and of that, sideways
  double held_ = 0.0, measured_ = 0.0, filtered_ = 0.0, wanted_ = 0.0, commanded_ = 0.0, ideal_ = 0.0;  // J
  double led_ = 0.0;  // J, of the ideal, on the way of a surface that moves
  ResponseState at_command_, at_tip_;
  const Object* object_ = nullptr;
  double depth_ = 0.0, threshold_ = 0.0;  // m, N
  double loaded_ = 0.0;                   // J: what the object would have given back at the begin
  double left_ = 0.0;  // J, that was put in and that the object still holds; below 0: more came out
};

}  // namespace enc::trial
