// The last word before a machine that takes positions: can it do what it is asked? Internal to the core.
#pragma once

#include <limits>

#include "core/control/safety/braking.h"
#include "core/control/safety/inside.h"
#include "core/control/stages/displacing.h"
#include "core/control/stages/walk.h"

namespace enc::stages {

// How far the command may still go along a normal: out to the surface, in to the deflection limit.
struct Walls {
  Vec3 normal = Vec3::UnitZ();                                                                         // in W
  double out = std::numeric_limits<double>::infinity(), in = std::numeric_limits<double>::infinity();  // m
  double speed = std::numeric_limits<double>::infinity();  // along the normal, m/s
  double share = kAlongShare;                              // of the acceleration, along the normal
  double depth = kUnset;  // of the tip's centre in the object that it shall stay in, m
};

// Finite, reachable, slow enough, within the walls: writes the set-point into now.command. To be called once
// the machine has said where it is.
void limit_command(Walk& walk, CommonState& state, Commanded& now, const Walls& walls) noexcept;

// Where all of the tip is inside, of its centre, m.
[[nodiscard]] inline double least_depth(const Walk& walk) { return walk.scene.tip_radius + kSkin; }
[[nodiscard]] Brake brake_of(const Walk& walk, const Commanded& now);

}  // namespace enc::stages
