// Last check before a machine that takes positions: makes each command one that the machine can follow.
// Internal to the core.
#pragma once

#include <limits>

#include "core/control/safety/inside.h"
#include "core/control/stages/displacement.h"

namespace enc::stages {

// Distance that the command may still go along a normal: out to the surface, in to the deflection limit.
struct Walls {
  Vec3 normal = Vec3::UnitZ();                                                                         // in W
  double out = std::numeric_limits<double>::infinity(), in = std::numeric_limits<double>::infinity();  // m
  double speed = std::numeric_limits<double>::infinity();  // m/s, along the normal
  double share = kAlongShare;                              // share of the acceleration, along the normal
  // Current depth of the tip's centre in the object that it must stay inside, m; unset: it may leave.
  double depth = kUnset;
};

// Writes a set-point into now.command that is finite, reachable, slow enough and within the walls. Call it
// only after the machine has reported its position.
void limit_command(ManipulatorContext& context, CommonState& state, CommandState& now,
                   const Walls& walls) noexcept;

// Depth of the tip's centre at which the whole tip is inside, m.
[[nodiscard]] inline double least_depth(const ManipulatorContext& context) {
  return context.scene.tip_radius + kSkin;
}
[[nodiscard]] Brake brake_of(const ManipulatorContext& context, const CommandState& now);

}  // namespace enc::stages
