#include <array>

#include "benchmarks/bench.h"
#include "benchmarks/indentation/indentation.h"

namespace enc::bench {

std::span<const Benchmark> benchmarks() {
  static constexpr auto kAll = std::to_array<Benchmark>({
      {"dent", "tennis_ball",
       "the seen surface: contact vertex, volume, time of an update of 10,242 vertices", run_dent},
      {"encounter", "tennis_ball",
       "distance from the true tool tip to the haptic-tip at first touch, over approach speed",
       run_encounter},
      {"indentation", "indentation",
       "a hand replicates indentations A, B, C on the virtual ball (VHMR Figs 8 and 10, Table 2); "
       "directions, lag",
       run_indentation},
      {"press", "tennis_ball", "one contact for each press, limit held, tip inside, no pull", run_press},
      {"response", "tennis_ball", "both response models: minor loops, jumps, tremor at rest, energy",
       run_response},
      {"mesh", "tennis_ball", "a ball of a million triangles: from file to tree, and step() on it", run_mesh},
      {"nearest", "geodesic ball", "nearest point on a mesh: time, growth, jumps, race against Embree",
       run_nearest},
      {"speed", "tennis_ball", "step(), times real time, wrapper over raw mj_step", run_speed},
      {"stiffness", "stiffness", "apparent over commanded stiffness, softest stable wall (VHMR Fig 3)",
       run_stiffness},
      {"structure", "tennis_ball", "hexapod on elastic legs: sag, modes, order of the integrator, cost",
       run_structure},
      {"tracking", "tracking",
       "the tracker against the machine that carries the tool (VHMR Table 1); latency of a log; prediction",
       run_tracking},
      {"workspace", "tennis_ball",
       "box and volume of the tip's travel, tracker's volume, directions from which the ball can be pressed",
       run_workspace},
  });
  return kAll;
}

}  // namespace enc::bench
