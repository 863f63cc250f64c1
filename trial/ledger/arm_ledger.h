// The ledger of an arm, which takes a force and gives way (arm_law.h).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "trial/ledger/arm_law.h"
#include "trial/ledger/ledger.h"

namespace enc::trial {

class ArmLedger {
 public:
  explicit ArmLedger(const models::Setup& setup);
  void see(const Glance& glance);  // each tick of a run that is simulated
  // Of one that lasts when the run ends, what it is by then.
  [[nodiscard]] std::vector<ContactLedger> contacts() const;

 private:
  // All that the period from a tick on is counted with.
  struct Known {
    bool there = false;
    LawAt law;
    TipAt tip;                         // true
    Vec3 held, late, counted;          // N
    Mat3 jacobian;                     // m/rad, in W
    PerJoint weight{}, compensated{};  // N m: what the motors must do, and do
    PerJoint joints{}, rates{};        // true
  };
  // Of the law where its encoders say that the arm is: they stand for some ticks.
  struct Posture {
    PerJoint joints{kUnset, kUnset, kUnset}, compensated{};
    Mat3 jacobian;
    double damping = kUnset;
  };
  [[nodiscard]] const Posture& posture(const PerJoint& joints, const Impedance& law);
  [[nodiscard]] Known know(const Glance& glance, const Impedance& law);
  void filter(const Glance& glance, const Impedance& law, Known& now);
  void count(const Known& now, const sim::Work& work);
  void open(const Known& from, const Glance& glance, double t);
  void close(double t);
  [[nodiscard]] ContactLedger so_far(double t) const;

  Arm machine_;  // true
  double prop_mass_;
  double dt_ = kUnset, last_t_ = 0.0;  // s
  std::int64_t window_;                // ticks, of the device's velocity
  static constexpr std::size_t kRing = 64;
  std::array<PerJoint, kRing> read_{};
  std::int64_t reads_ = 0;
  Vec3 error_ = Vec3::Zero(), rate_ = Vec3::Zero();  // filtered, of the true state
  Aim aim_;                                          // of the last tick
  Known before_;
  Posture posture_;
  bool on_ = false;
  ContactLedger sum_;
  double ideal_ = 0.0, work_held_ = 0.0, work_late_ = 0.0, work_counted_ = 0.0, work_given_ = 0.0;  // J
  Known first_;
  std::vector<ContactLedger> contacts_;
};

}  // namespace enc::trial
