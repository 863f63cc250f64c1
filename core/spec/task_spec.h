// Keys of a single task: [probe] and [travel] of a scene file (scene_spec.h); SI.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

// The indentation test rig of [VHMR 4.2, Fig 7]: the machine itself pushes a sphere into a real object and
// measures it, without a user and without rendering.
struct ProbeSpec {
  std::string object;    // object to press; empty: the first
  double azimuth = 0.0;  // axis out of the object: angle from +x towards +y of W, rad
  double polar = M_PI;   // axis out of the object: angle from +z of W, rad; pi pushes from below, straight up
  double offset = 0.0;   // m, sideways of the axis through the object's origin, towards growing polar
  double radius = 0.010;  // m, radius of the sphere, which replaces the haptic-tip
  double depth = 0.006;   // m, depth of a push along the axis, from the first touch of the undeformed object
  double speed = 0.004;   // m/s, of pushing and going back
  double clear = 0.004;   // m above the first touch: start and end of a push
  double dwell = 0.0;     // s, at depth
  double rest = 2.0;      // s, clear of the object before each push
  std::int64_t repeats = 5;
};

struct ProbePart {
  std::optional<ProbeSpec> probe;
};

enum class TravelWays : std::uint8_t {
  one_way,   // stop by stop to the last, then straight back to the start
  both_ways  // stop by stop to the last and back
};
constexpr auto words(TravelWays) { return enum_words("one_way", "both_ways"); }
// Tracking test: the machine carries a clamped tool past the tracker, from stop to stop [VHMR 4.1, Fig 6],
// without a user and without rendering.
struct TravelSpec {
  std::string axes = "xyz";     // axes of W, one after another
  Vec3 start{0.0, 0.0, -0.02};  // m, of the travel along each axis; the other two axes stay at 0
  std::vector<double> stops{0.0, 0.005, 0.010, 0.020, 0.040};  // m, from the start, towards +
  TravelWays ways = TravelWays::one_way;
  double speed = 0.020;      // m/s
  double dwell = 5.0;        // s, at each stop
  std::int64_t repeats = 1;  // repeats of the whole travel
};

struct TravelPart {
  std::optional<TravelSpec> travel;
};

}  // namespace enc
