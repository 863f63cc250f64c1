// What an arm and its prop really are: [truth.arm]. A part of twin_spec.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/base/words.h"
#include "core/spec/arm_rig.h"

namespace enc::sim {

enum class ArmFriction : std::uint8_t {
  dry,    // Coulomb: holds what is at rest
  smooth  // c tanh(10 qd), as in the published model of the machine: at rest it holds nothing
};
constexpr auto words(ArmFriction) { return enum_words("dry", "smooth"); }

// What a prop's front faces: the surface that the core believes to be met; or, for comparison, the one that
// the finger truly comes to.
enum class PropFacing : std::uint8_t { told, finger };
constexpr auto words(PropFacing) { return enum_words("told", "finger"); }

struct ArmTruth {
  bool there = false;  // the file has it
  double timestep =
      0.001;  // s, of MuJoCo. First-order integrators move a wall's stability boundary (sources/twin 1)
  std::string integrator = "rk4";
  ArmMachine machine;
  double mass_scale = 1.0;  // of all masses and inertias against the machine's: what the rig does not know
  std::array<double, kMostJoints> counts{4096.0, 4096.0,
                                         4096.0};  // of an encoder, for each turn of its motor
  ArmFriction friction_form = ArmFriction::dry;
  std::array<double, kMostJoints> friction{0.01, 0.01, 0.01};  // Coulomb, at the joint, N m or N
  double friction_time = 0.020;  // s, of the dry form, in which it sets in: a damper to what is slower
  std::array<double, kMostJoints> viscous{0.0005, 0.0005, 0.0005};   // N m s/rad or N s/m
  std::array<double, kMostJoints> peak_torque{0.129, 0.129, 0.129};  // of the motor, N m
  std::array<double, kMostJoints> continuous_torque{0.0286, 0.0286, 0.0286};
  Thermal thermal{};
  double velocity_window = 0.002;  // s, over which the device differences its encoders
  double watchdog = 0.005;         // s without a command, then the motors are off
  double drum_time = 0.020;        // s, of the motor that drives a prop's surface
  double gimbal_time = 0.030;      // s, in which the prop turns to another surface
  PropFacing facing = PropFacing::told;
  double prop_friction = 0.6;   // of a finger on the prop
  double contact_time = 0.004;  // s, of the stop between finger and prop: a hard contact
  // Of a drum's belt, which gives under a finger. MuJoCo's friction of what slips at the speed s lifts it off
  // by s times friction times twice the time constant of that friction: from a hard belt a finger hops.
  double belt_time = 0.005;           // s, of its stop: with the next, 0.2 mm/N under a finger of 20 g
  double belt_impedance = 0.8;        // of its stop (MuJoCo's d)
  double belt_friction_time = 0.030;  // s, of its friction
  Vec3 misplaced{0, 0, 0};            // of the base against the believed X_WR, m
  Vec3 turned{0, 0, 0};               // rad
};

// The machine with the masses and inertias that it really has. Its motors are known.
[[nodiscard]] inline ArmMachine true_machine(const ArmTruth& truth) {
  ArmMachine machine = truth.machine;
  PhantomGeometry& g = machine.phantom;
  for (double* mass : {&g.m_a, &g.m_c, &g.m_be, &g.m_df, &g.I_base}) *mass *= truth.mass_scale;
  for (Vec3* inertia : {&g.I_a, &g.I_c, &g.I_be, &g.I_df}) *inertia *= truth.mass_scale;
  for (ChainLink& link : machine.links) {
    link.mass *= truth.mass_scale;
    link.inertia *= truth.mass_scale;
  }
  return machine;
}

}  // namespace enc::sim
