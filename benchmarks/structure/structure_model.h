// The machine alone, legs and platform, for the benchmark `structure`: as tendons, which is what the twin
// uses, and as a closed loop of bodies with `connect` constraints, which exists for comparison only.
#pragma once

#include "sim/bodies/legs.h"

namespace enc::bench::structure {

enum class LegForm : std::uint8_t { tendon, connect };

// How the servo moves H: 10 mm and 3 degrees at 1 Hz, slanted, from a sudden start.
struct LegCommand {
  Pose<'R', 'H'> pose;
  Vec<'R'> velocity, turning;
};
[[nodiscard]] LegCommand swing(const Hexapod& machine, double t);

class LegModel {
 public:
  LegModel(LegForm form, const sim::StructureTruth& truth);

  void step(const LegCommand& from, const LegCommand& to);  // one physics step
  void push(const Vec3& force);                             // on H, N, until the next call
  [[nodiscard]] Vec3 tip() const;                           // H in R, m
  [[nodiscard]] double gap() const;                         // of the loops, m; 0 for tendons
  // The natural frequencies of the equations of motion, by differences of qacc, ascending, Hz (tendons).
  [[nodiscard]] Hexapod::Lengths measured_modes();
  [[nodiscard]] const Hexapod& machine() const { return machine_; }
  [[nodiscard]] const sim::Legs& legs() const { return legs_; }
  [[nodiscard]] sim::Physics& physics() { return physics_; }

 private:
  Hexapod machine_;
  sim::Physics physics_;
  sim::Legs legs_;
  int qpos_ = 0, dof_ = 0;  // of the platform
};

}  // namespace enc::bench::structure
