// The energy balance of a machine that takes positions and measures force. It cannot be driven back: the
// servo takes the hand's work on the tip, and returns it as the law requires.
//
// The ideal is the object's response at the true depth of the tip, along its true path. Below the force
// threshold the hand presses with that much more. The differences between the ideal and the acting force are
// split as follows:
//
//   true          from a sensor without any error
//   held          the true force of the tick                    true - held:       sampling
//   measured      counts, noise, zero                           held - measured:   quantisation
//   filtered      behind the low-pass                           measured - filtered: delay
//   wanted        object's force at the law's position          filtered - wanted: limits, or its damper
//   commanded     object's force at the commanded position      wanted - commanded: limits
//   ideal         object's force at the tip                     commanded - ideal: delay
#pragma once

#include <optional>

#include "trial/ledger/ledger.h"

namespace enc::trial {

class HexapodLedger {
 public:
  // N, outwards along the normal, from a tick until the next.
  struct Forces {
    double held = 0.0, measured = 0.0, filtered = 0.0, wanted = 0.0, commanded = 0.0, ideal = 0.0;
  };
  struct TickState {
    Vec3 normal = Vec3::UnitZ(), tip = Vec3::Zero(), felt = Vec3::Zero();  // felt: true force, N
    Forces force;
    double depth = 0.0;    // m, tip in the object
    bool engaged = false;  // the object is rendered
  };

  // The interface that Book needs.
  [[nodiscard]] bool tick(const Glance& glance);
  void rest(const Glance& /*glance*/) {}
  [[nodiscard]] TickState know(const Glance& glance, const std::optional<TickState>& was);
  [[nodiscard]] static bool believed(Mode mode) { return mode == Mode::contact || mode == Mode::restore; }
  [[nodiscard]] static bool rendered(const TickState& /*now*/) { return true; }
  void open(const TickState& from);
  void count(const TickState& was, const TickState& now, const sim::Work& work);
  [[nodiscard]] ContactLedger so_far(const TickState& last) const;

 private:
  ContactLedger sum_;
  bool damped_ = false;
  double sensed_ = 0.0, across_ = 0.0;  // J, by the sensor; and its sideways part
  double held_ = 0.0, measured_ = 0.0, filtered_ = 0.0, wanted_ = 0.0, commanded_ = 0.0, ideal_ = 0.0;  // J
  double led_ = 0.0;  // J, ideal, along the motion of a moving surface
  ResponseState at_command_, at_tip_;
  const Object* object_ = nullptr;
  double depth_ = 0.0, threshold_ = 0.0;  // m, N
  // J: energy that the object would have returned at the begin.
  double loaded_ = 0.0;
  // J, energy put in and still in the object; below 0: deficit.
  double left_ = 0.0;
};

}  // namespace enc::trial
