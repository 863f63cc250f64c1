// Where a person may reach for: even over the ball of a session, less what the machine cannot press [VHMR
// 4.4], or over the objects of a scene that an arm carries its prop to [VisHap 2.2].
#pragma once

#include <cstdint>

#include "core/control/scene/scene.h"
#include "sim/truth/random.h"

namespace enc::sim {

struct Place {
  std::int32_t object = -1;  // index in the scene
  PressPoint at;
};

class Places {
 public:
  // `prepared` must outlive it.
  Places(const SceneSpec& scene, const Scene& prepared);

  [[nodiscard]] Place draw(Stream& draws, const Tool& tool) const;
  // From the tool's tip to the nearest object, m.
  [[nodiscard]] double gap(const Point<'W'>& tip, const Tool& tool) const;

 private:
  [[nodiscard]] PressPoint on(const Object& object, Stream& draws) const;
  [[nodiscard]] bool pressable(const Place& place, const Tool& tool) const;

  const Scene& scene_;
  bool everywhere_;         // on all objects
  std::int32_t ball_;       // else on this one
  double lowest_, spread_;  // cosine of the largest polar angle; m
};

}  // namespace enc::sim
