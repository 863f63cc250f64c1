// The energy balance of an arm, which takes a force and gives way. It compares these forms of the law's force
// on the tip, N in W [VisHap eq. 2, 7]:
//
//   ideal     Lambda (K e + K_v de/dt) at the true state of this very moment; Lambda and a button's sink
//             depth follow the true depth
//   held      the ideal force of a tick, kept until the next one
//   late      with the velocity window, the filters of eq. 3, and the delay of the gain
//   counted   the late force from encoder counts: the force that the core requests
//
// The target, the normal and a ball's firmness are inputs: they define the rendered object, right or wrong.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/control/task/tasks.h"
#include "trial/ledger/ledger.h"

namespace enc::trial {

// The law at a tick.
struct LawAt {
  bool live = false;  // the law pushes
  // true: by the curve of a touched object; false: as a free tip.
  bool felt = false;
  bool real = false;        // a real object: sideways as along the normal
  bool hit = false;         // a ball: it pushes only along the normal
  bool on_its_way = false;  // moves to a target that jumped
  const Object* object = nullptr;
  Vec3 normal = Vec3::UnitZ(), target = Vec3::Zero(), target_velocity = Vec3::Zero();
  Vec3 ball = Vec3::Zero();  // surface point of a struck ball
  double firmness = 1.0;
  double gain = 1.0, sunk = 0.0;          // the core's values
  double stiffness = 0.0, damping = 0.0;  // K, K_v
  Vec3 along = Vec3::Zero();              // N, feed-forward for an accelerated target
};

// The tip, by the machine's model.
struct TipAt {
  Vec3 at = Vec3::Zero(), velocity = Vec3::Zero();
};

// The law without its damping.
[[nodiscard]] LawAt law_at(const Glance& glance, const Impedance& law);
[[nodiscard]] Vec3 ideal_force(const LawAt& law, const TipAt& tip);
// Power taken by the damper, W.
[[nodiscard]] double damped(const LawAt& law, const TipAt& tip);
// Energy in the spring, J; Simpson's rule with `parts` parts.
[[nodiscard]] double stored(const LawAt& law, const TipAt& tip, int parts = 400);
// Force for an error and a rate behind their filters; `depth`: depth in a struck ball.
[[nodiscard]] Vec3 asked_force(const LawAt& law, const Vec3& error, const Vec3& rate, double depth);
// Depth of the tip in a struck ball, m.
[[nodiscard]] double ball_depth(const LawAt& law, const Vec3& tip);
// The law between two ticks; if it changes there, the law of the second tick.
[[nodiscard]] LawAt between(const LawAt& a, const LawAt& b);

class ArmLedger {
 public:
  // All values needed for the period that begins at a tick.
  struct TickState {
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
  [[nodiscard]] TickState know(const Glance& glance, const std::optional<TickState>& was);
  [[nodiscard]] static bool believed(Mode mode) { return mode == Mode::contact; }
  [[nodiscard]] static bool rendered(const TickState& now) { return !now.law.real; }
  void open(const TickState& from);
  void count(const TickState& was, const TickState& now, const sim::Work& work);
  [[nodiscard]] ContactLedger so_far(const TickState& last) const;

 private:
  // Values of the law at the encoders' joint angles, which stay constant for some ticks.
  struct Posture {
    PerJoint joints{kUnset, kUnset, kUnset}, compensated{};
    Mat3 jacobian;
    Vec3 against_weight = Vec3::Zero();  // N, in R
    double damping = kUnset;
  };
  [[nodiscard]] const Posture& posture(const PerJoint& joints, const Impedance& law);
  void tell(const Glance& glance, const Impedance& law, const std::optional<TickState>& was, TickState& now);
  void count_ideal(const TickState& was, const TickState& now, const Vec3& led);
  void filter(const Glance& glance, const Impedance& law, const std::optional<TickState>& was,
              TickState& now);

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
  TickState first_;
};

}  // namespace enc::trial
