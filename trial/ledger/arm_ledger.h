// The energy balance of an arm, which takes a force and gives way (arm_law.h).
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "trial/ledger/arm_law.h"
#include "trial/ledger/ledger.h"

namespace enc::trial {

class ArmLedger {
 public:
  // All values needed for the period that begins at a tick.
  struct Known {
    LawAt law;
    TipAt tip;                         // ground truth
    Vec3 held, late, counted, given;   // N
    Mat3 jacobian;                     // m/rad, in W
    PerJoint weight{}, compensated{};  // N m: required and actual gravity compensation of the motors
    PerJoint joints{}, rates{};        // ground truth
  };

  explicit ArmLedger(const models::Setup& setup);
  // The interface that Book needs.
  [[nodiscard]] bool tick(const Glance& glance);
  void rest(const Glance& glance);
  [[nodiscard]] Known know(const Glance& glance, const std::optional<Known>& was);
  [[nodiscard]] static bool believed(Mode mode) { return mode == Mode::contact; }
  [[nodiscard]] static bool rendered(const Known& now) { return !now.law.real; }
  void open(const Known& from);
  void count(const Known& was, const Known& now, const sim::Work& work);
  [[nodiscard]] ContactLedger so_far(const Known& last) const;

 private:
  // Values of the law at the encoders' joint angles, which stay constant for some ticks.
  struct Posture {
    PerJoint joints{kUnset, kUnset, kUnset}, compensated{};
    Mat3 jacobian;
    Vec3 against_weight = Vec3::Zero();  // N, in R
    double damping = kUnset;
  };
  [[nodiscard]] const Posture& posture(const PerJoint& joints, const Impedance& law);
  void tell(const Glance& glance, const Impedance& law, const std::optional<Known>& was, Known& now);
  void count_ideal(const Known& was, const Known& now, const Vec3& led);
  void filter(const Glance& glance, const Impedance& law, const std::optional<Known>& was, Known& now);

  Arm machine_;  // ground truth
  double prop_mass_;
  double dt_ = kUnset;   // s
  std::int64_t window_;  // ticks, window of the device's velocity
  static constexpr std::size_t kRing = 64;
  std::array<PerJoint, kRing> read_{};
  std::int64_t reads_ = 0;
  Vec3 error_ = Vec3::Zero(), rate_ = Vec3::Zero();  // filtered, from the true state
  Aim aim_;                                          // state of the last tick
  Posture posture_;
  ContactLedger sum_;
  double ideal_ = 0.0, work_held_ = 0.0, work_late_ = 0.0, work_counted_ = 0.0, work_given_ = 0.0;  // J
  // J, along the target's motion.
  double led_ideal_ = 0.0, led_held_ = 0.0, led_late_ = 0.0, led_counted_ = 0.0;
  double spring_ = 0.0;  // J, spring energy at the last tick
  // J, energy put in and still in the spring; below 0: deficit.
  double left_ = 0.0;
  Known first_;
};

}  // namespace enc::trial
