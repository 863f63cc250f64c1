// The law of an arm as its ideal, and as the core does it: force on the tip, N in W [VisHap eq. 2, 7].
//
//   ideal     Lambda (K e + K_v de/dt) at the true state of this very moment, Lambda and what a button sinks
//   by
//             the true depth
//   held      the same at a tick, until the next one
//   late      through the velocity window, the filters of eq. 3, and a gain that needs its time
//   counted   the same of what the encoders say: what the core asks for
//
// The target, the normal and how firm a ball is are given: they are what is rendered, right or wrong.
#pragma once

#include <array>
#include <cstdint>

#include "core/control/task/state.h"
#include "trial/trial.h"

namespace enc::trial {

// What the law is at a tick.
struct LawAt {
  bool live = false;        // it pushes
  bool felt = false;        // by the curve of an object that is touched; else as a free tip
  bool real = false;        // sideways as along the normal
  bool hit = false;         // a ball pushes along the normal, and nothing else
  bool on_its_way = false;  // to a target that leapt
  const Object* object = nullptr;
  Vec3 normal = Vec3::UnitZ(), target = Vec3::Zero(), target_velocity = Vec3::Zero();
  Vec3 ball = Vec3::Zero();  // where the surface of one that is hit is
  double firmness = 1.0;
  double gain = 1.0, sunk = 0.0;          // as the core has them
  double stiffness = 0.0, damping = 0.0;  // K, K_v
  Vec3 along = Vec3::Zero();              // N, to go along with a target that is accelerated
};

// The tip, by the machine that is believed.
struct TipAt {
  Vec3 at = Vec3::Zero(), velocity = Vec3::Zero();
};

// All but its damping.
[[nodiscard]] LawAt law_at(const Glance& glance, const Impedance& law);
[[nodiscard]] Vec3 ideal_force(const LawAt& law, const TipAt& tip);
// W, taken by the damper.
[[nodiscard]] double damped(const LawAt& law, const TipAt& tip);
// J, in its spring; by Simpson's rule in so many parts.
[[nodiscard]] double stored(const LawAt& law, const TipAt& tip, int parts = 400);
// By an error and a rate behind their filters; `depth`: of a ball that is hit.
[[nodiscard]] Vec3 asked_force(const LawAt& law, const Vec3& error, const Vec3& rate, double depth);
// m, of the tip in a ball that is hit.
[[nodiscard]] double ball_depth(const LawAt& law, const Vec3& tip);
// Between two ticks; where the law is another one then, that of the second.
[[nodiscard]] LawAt between(const LawAt& a, const LawAt& b);

}  // namespace enc::trial
