// [travel] of a scene file (scene_spec.h); SI.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

// Tracking test: the machine carries a clamped tool past the tracker, from stop to stop [VHMR 4.1, Fig 6],
// without a user and without rendering.
enum class TravelWays : std::uint8_t {
  one_way,   // stop by stop to the last, then straight back to the start
  both_ways  // stop by stop to the last and back
};
constexpr auto words(TravelWays) { return enum_words("one_way", "both_ways"); }
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
