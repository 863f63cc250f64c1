// Points that a person may reach for: uniform over the ball of a session, except where the machine cannot
// press [VHMR 4.4], or over the objects to which an arm carries its prop [VisHap 2.2].
#pragma once

#include <cstdint>

#include "core/control/scene/scene.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

struct Place {
  std::int32_t object = -1;  // index in the scene
  PressPoint at;
};

// What a person does with one machine and not with the other.
struct HandAtMachine {
  // The stiffness that the person has learned to expect of an object, N/m.
  double (*expected)(const Object& object);
  bool (*pressable)(const Scene& scene, const Place& place, const Tool& tool);
};
[[nodiscard]] const HandAtMachine& hand_at(const SceneSpec& scene);

class Places {
 public:
  // `prepared` must outlive it.
  Places(const SceneSpec& scene, const Scene& prepared);

  [[nodiscard]] Place draw(Stream& draws, const Tool& tool) const;
  // Distance from the tool's tip to the nearest object, m.
  [[nodiscard]] double gap(const Point<'W'>& tip, const Tool& tool) const;

 private:
  [[nodiscard]] PressPoint on(const Object& object, Stream& draws) const;

  const HandAtMachine& hand_;
  const Scene& scene_;
  bool everywhere_;         // true: all objects
  std::int32_t ball_;       // otherwise this object
  double lowest_, spread_;  // cosine of the largest polar angle; m
};

}  // namespace enc::sim
