// The law of an arm, in its ideal form and as the core executes it: force on the tip, N in W
// [VisHap eq. 2, 7].
//
//   ideal     Lambda (K e + K_v de/dt) at the true state of this very moment; Lambda and a button's sink
//   depth
//             follow the true depth
//   held      the ideal force of a tick, kept until the next one
//   late      with the velocity window, the filters of eq. 3, and the delay of the gain
//   counted   the late force from encoder counts: the force that the core asks for
//
// The target, the normal and a ball's firmness are inputs: they define the rendered object, right or wrong.
#pragma once

#include <array>
#include <cstdint>

#include "core/control/task/state.h"
#include "trial/trial.h"

namespace enc::trial {

// The law at a tick.
struct LawAt {
  bool live = false;  // it pushes
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
// Force for an error and a rate behind their filters; `depth`: in a struck ball.
[[nodiscard]] Vec3 asked_force(const LawAt& law, const Vec3& error, const Vec3& rate, double depth);
// Depth of the tip in a struck ball, m.
[[nodiscard]] double ball_depth(const LawAt& law, const Vec3& tip);
// The law between two ticks; if it changes there, the law of the second tick.
[[nodiscard]] LawAt between(const LawAt& a, const LawAt& b);

}  // namespace enc::trial
