// The legs of the structural form: six tendons between base and platform joints. Each is a spring and a
// damper in parallel, and the servo moves its free length. The platform is a free body carried only by the
// legs, so it sags, vibrates and loads its legs; the servo in front of them stays (hexapod_plant.h).
// [sources/twin 1]
#pragma once

#include "core/machine/hexapod.h"
#include "sim/bodies/mujoco.h"
#include "sim/spec/twin_spec.h"

namespace enc::sim {

// The servo's target for the legs and their speed: m, m/s.
struct LegMotion {
  Hexapod::Lengths length, rate;
};

class Legs {
 public:
  // Adds masses, joints, tendons and actuators to a spec with the bodies `base` and `platform`. moved_mass:
  // platform and everything behind the sensor, kg.
  static void build(mjSpec* spec, const Hexapod& machine, const StructureTruth& truth, double moved_mass);

  // Legs of a compiled world with the machine at X_WR. Calibrates the zero: the free lengths carry the weight
  // on the legs there, without the payload, so that at rest H is at the servo's pose. Throws Error if the
  // time step is too long for the stiffest mode.
  Legs(const StructureTruth& truth, const Hexapod& machine, Physics& physics, const Pose<'W', 'R'>& X_WR);

  // Free lengths for a pose and its motion.
  [[nodiscard]] LegMotion at(const Pose<'R', 'H'>& X_RH, const Vec<'R'>& velocity,
                             const Vec<'R'>& turning) const noexcept;
  // Sets the free lengths of the coming step, from one motion to the other: a cubic of time, which every
  // stage of the integrator evaluates at its own time. Constant lengths over a step would be half a step
  // late.
  void drive(mjData* data, const LegMotion& from, const LegMotion& to, double h) const noexcept;
  // Force of each leg on the platform, N.
  [[nodiscard]] Hexapod::Lengths forces(const mjData* data) const noexcept;

  // Stiffness J^T K J at zero, for H, along and about the axes of R; N/m, N, N m.
  [[nodiscard]] Hexapod::Jacobian stiffness() const;
  // Natural frequencies of that stiffness with the mass of the physics, ascending, Hz.
  [[nodiscard]] const Hexapod::Lengths& modes() const { return modes_; }
  [[nodiscard]] double damping() const { return damping_; }  // of a leg, N s/m

 private:
  Hexapod machine_;
  double stiffness_, damping_;
  Hexapod::Lengths preload_;  // m: extra free length of the legs at zero
  Hexapod::Lengths modes_;
};

}  // namespace enc::sim
