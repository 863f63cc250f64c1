// The legs of the structural form: six tendons between base and platform joints, each a spring and a damper
// in parallel whose free length the servo moves. The platform is a free body that hangs on them alone, so it
// sags, vibrates and loads its legs; the servo in front (hexapod_plant.h) stays. [sources/twin 1]
#pragma once

#include "core/machine/hexapod.h"
#include "sim/bodies/mujoco.h"
#include "sim/spec/twin_spec.h"

namespace enc::sim {

// Where the servo has its legs and how fast they move: m, m/s.
struct LegMotion {
  Hexapod::Lengths length, rate;
};

class Legs {
 public:
  // Puts masses, joints, tendons and actuators into a spec that has the bodies `base` and `platform`.
  // moved_mass: platform and what is behind the sensor, kg.
  static void build(mjSpec* spec, const Hexapod& machine, const StructureTruth& truth, double moved_mass);

  // Of a compiled world with the machine at X_WR. The zero is calibrated here: the free lengths carry the
  // weight that is on the legs there, without the payload, so that at rest H is where the servo says. Throws
  // Error where the time step is too long for the stiffest mode.
  Legs(const StructureTruth& truth, const Hexapod& machine, Physics& physics, const Pose<'W', 'R'>& X_WR);

  // Free lengths for a pose and its motion.
  [[nodiscard]] LegMotion at(const Pose<'R', 'H'>& X_RH, const Vec<'R'>& velocity,
                             const Vec<'R'>& turning) const noexcept;
  // The free lengths of the coming step, from one motion to the other: a cubic of time, which every stage of
  // the integrator reads at its own time. Held over a step they would come half a step late.
  void drive(mjData* data, const LegMotion& from, const LegMotion& to, double h) const noexcept;
  // With which each leg pushes the platform, N.
  [[nodiscard]] Hexapod::Lengths forces(const mjData* data) const noexcept;

  // J^T K J at zero: of H, along and about the axes of R; N/m, N, N m.
  [[nodiscard]] Hexapod::Jacobian stiffness() const;
  // The natural frequencies of that stiffness and the mass of the physics, ascending, Hz.
  [[nodiscard]] const Hexapod::Lengths& modes() const { return modes_; }
  [[nodiscard]] double damping() const { return damping_; }  // of a leg, N s/m

 private:
  Hexapod machine_;
  double stiffness_, damping_;
  Hexapod::Lengths preload_;  // m: what the legs are longer by at zero
  Hexapod::Lengths modes_;
};

}  // namespace enc::sim
