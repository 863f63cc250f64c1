// [probe] of a scene file (scene_spec.h); SI.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/frames.h"

namespace enc {

// The test rig of [VHMR 4.2, Fig 7]: the machine itself pushes a sphere into a real object and measures it.
// Nobody holds a tool, and nothing is rendered.
struct ProbeSpec {
  std::string object;     // pressed; empty: the first
  double azimuth = 0.0;   // of the axis out of the object, from +x towards +y of W, rad
  double polar = M_PI;    // and from +z of W, rad: pi is pushed from below, straight up
  double offset = 0.0;    // sideways of the axis through the object's origin, towards growing polar, m
  double radius = 0.010;  // of the sphere that the machine carries instead of its haptic-tip, m
  double depth = 0.006;   // of a push, from the first touch of the undeformed object along the axis, m
  double speed = 0.004;   // of pushing and going back, m/s
  double clear = 0.004;   // above the first touch, where a push begins and ends, m
  double dwell = 0.0;     // at depth, s
  double rest = 2.0;      // clear of the object before each push, s
  std::int64_t repeats = 5;
};

struct ProbePart {
  std::optional<ProbeSpec> probe;
};

}  // namespace enc
