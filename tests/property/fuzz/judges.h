// What judges each tick of a fuzz: modes with their causes, commands within their limits. Empty: nothing is
// wrong.
#pragma once

#include <string>

#include "core/control/scene/scene.h"
#include "core/control/step.h"

namespace enc::test {

// Ticks for which a mode has gone on without its cause (mode.h), by what the core itself believes.
class Modes {
 public:
  std::int64_t judged = 0;  // ticks on which a hold would have been one too many
  std::string judge(const Scene& scene, const State& state, const Outputs& out, bool well);

 private:
  double well_ = 0.0, far_ = 0.0, restore_ = 0.0, loose_ = 0.0, in_contact_ = 0.0;
  double alone_ = 0.0,
         same_force_ = 0.0;  // s for which a force of so many N stayed the same, its tool out of view
};

// Commands of a position-controlled machine; targets of an arm.
class Limits {
 public:
  std::string judge(const Scene& scene, const State& state, const Outputs& out);

 private:
  std::string judge_machine(const Scene& scene, const State& state, const Outputs& out);
  std::string judge_arm(const Scene& scene, const State& state, const Outputs& out);
  static bool anew(const Outputs& out) { return out.mode == Mode::hold; }

  bool known_ = false;
  Vec3 before_{0, 0, 0}, velocity_{0, 0, 0};
};

}  // namespace enc::test
