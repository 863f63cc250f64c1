// Ground truth of an arm and its prop: [truth.arm]. A part of twin_spec.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/base/words.h"
#include "core/spec/rendering_rig.h"

namespace enc::sim {

enum class ArmFriction : std::uint8_t {
  dry,    // Coulomb: holds a joint at rest
  smooth  // c tanh(10 qd), as in the published model of the machine: holds nothing at rest
};
constexpr auto words(ArmFriction) { return enum_words("dry", "smooth"); }

// The surface that a prop's front faces: the one in the core's command or, for comparison, the one that the
// finger truly approaches.
enum class PropFacing : std::uint8_t { told, finger };
constexpr auto words(PropFacing) { return enum_words("told", "finger"); }

struct ArmTruth {
  bool there = false;  // the file has this table
  // s, MuJoCo's step. First-order integrators move a wall's stability boundary (sources/twin 1).
  double timestep = 0.001;
  std::string integrator = "rk4";
  ArmMachine machine;
  double mass_scale = 1.0;  // factor on all masses and inertias, unknown to the rig
  std::array<double, kMostJoints> counts{4096.0, 4096.0,
                                         4096.0};  // encoder counts for each turn of its motor
  ArmFriction friction_form = ArmFriction::dry;
  std::array<double, kMostJoints> friction{0.01, 0.01, 0.01};  // Coulomb, at the joint, N m or N
  double friction_time = 0.020;  // s, onset of the dry form: a damper for slower motion
  std::array<double, kMostJoints> viscous{0.0005, 0.0005, 0.0005};   // N m s/rad or N s/m
  std::array<double, kMostJoints> peak_torque{0.129, 0.129, 0.129};  // motor's, N m
  std::array<double, kMostJoints> continuous_torque{0.0286, 0.0286, 0.0286};
  ThermalModel thermal{};
  double velocity_window = 0.002;  // s, over which the device differences its encoder readings
  double watchdog = 0.005;         // s without a command before the motors switch off
  // s, time constant of the motor that drives a prop's surface.
  double drum_time = 0.020;
  double gimbal_time = 0.030;  // s, in which the prop turns to another surface
  PropFacing facing = PropFacing::told;
  double prop_friction = 0.6;   // finger on the prop
  double contact_time = 0.004;  // s, stop between finger and prop: a hard contact
  // A drum's belt, which yields under a finger. MuJoCo's friction lifts a body that slips at the speed s off
  // by s times friction times twice the friction's time constant: a finger hops on a hard belt.
  double belt_time = 0.005;           // s, of its stop: with belt_impedance, 0.2 mm/N under a finger of 20 g
  double belt_impedance = 0.8;        // its stop (MuJoCo's d)
  double belt_friction_time = 0.030;  // s, its friction
  Vec3 misplaced{0, 0, 0};            // base against the rig's X_WR, m
  Vec3 turned{0, 0, 0};               // rad
};

// The machine with its true masses and inertias. Its motors are known.
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
