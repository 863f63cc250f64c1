// What an arm and its prop really are: [truth.arm]. A part of twin_spec.h.
#pragma once

#include <array>

#include "core/arm.h"

namespace enc::sim {

struct ArmTruth {
  ArmMachine machine;
  double mass_scale = 1.0;  // of all masses and inertias against the machine's: what the rig does not know
  std::array<double, kMostJoints> counts{4096.0, 4096.0,
                                         4096.0};              // of an encoder, for each turn of its motor
  std::array<double, kMostJoints> friction{0.01, 0.01, 0.01};  // Coulomb, at the joint, N m or N
  std::array<double, kMostJoints> viscous{0.0005, 0.0005, 0.0005};   // N m s/rad or N s/m
  std::array<double, kMostJoints> peak_torque{0.129, 0.129, 0.129};  // of the motor, N m
  std::array<double, kMostJoints> continuous_torque{0.0286, 0.0286, 0.0286};
  double winding_time = 12.0;      // s, thermal
  double velocity_window = 0.002;  // s, over which the device differences its encoders
  double drum_time = 0.020;        // s, of the motor that drives a prop's surface
  double prop_friction = 0.6;      // of a finger on the prop
  Vec3 misplaced{0, 0, 0};         // of the base against the believed X_WR, m
  Vec3 turned{0, 0, 0};            // rad
};

}  // namespace enc::sim
