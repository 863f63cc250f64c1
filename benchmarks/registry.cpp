#include <array>

#include "benchmarks/bench.h"

namespace enc::bench {

std::span<const Benchmark> benchmarks() {
  static constexpr std::array<Benchmark, 4> kAll{{
      {"encounter", "tennis_ball",
       "distance from the true tool tip to the haptic-tip at first touch, over approach speed",
       run_encounter},
      {"press", "tennis_ball", "one contact for each press, limit held, tip inside, no pull", run_press},
      {"nearest", "geodesic ball", "nearest point on a mesh: time, growth, jumps, race against Embree",
       run_nearest},
      {"speed", "tennis_ball", "step(), times real time, wrapper over raw mj_step", run_speed},
  }};
  return kAll;
}

}  // namespace enc::bench
