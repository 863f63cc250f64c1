#include <array>

#include "benchmarks/bench.h"

namespace enc::bench {

std::span<const Benchmark> benchmarks() {
  static constexpr auto kAll = std::to_array<Benchmark>({
      {"dent", "tennis_ball",
       "the seen surface: contact vertex, volume, time of an update of 10,242 vertices", run_dent},
      {"deformation", "tennis_ball", "the seen ball's contour against that of a pressed ball (VHMR Fig 11)",
       run_deformation},
      {"encounter", "tennis_ball",
       "distance from the true tool tip to the haptic-tip at first touch, over approach speed",
       run_encounter},
      {"gravity", "wall",
       "gravity compensation of the arm: residual force over the workspace, catalogue, race against KDL "
       "(VisHap eq. 5)",
       run_gravity},
      {"identification", "rig_identify",
       "injected ball parameters out of a rig's loops: are they in the intervals, how wide are these",
       run_identification},
      {"indentation", "indentation",
       "a hand replicates indentations A, B, C on the virtual ball (VHMR Figs 8 and 10, Table 2); "
       "directions, lag",
       run_indentation},
      {"press", "tennis_ball", "one contact for each press, limit held, tip inside, no pull", run_press},
      {"reaching", "wall",
       "is the prop there before the finger, how far beside it and how hard do they meet (VisHap 2.2)",
       run_reaching},
      {"registration", "vishap",
       "camera and arm from pairs of places: error per axis, pairs and frames, time (VisHap 2.2)",
       run_registration},
      {"plane_button", "wall",
       "force over distance, wall and button (VisHap Figs 4, 5); late finger, step, limits",
       run_plane_button},
      {"response", "tennis_ball", "both response models: minor loops, jumps, tremor at rest, energy",
       run_response},
      {"mesh", "tennis_ball", "a ball of a million triangles: from file to tree, and step() on it", run_mesh},
      {"nearest", "geodesic ball", "nearest point on a mesh: time, growth, jumps, race against Embree",
       run_nearest},
      {"session", "session",
       "a user's two minutes: contacts, miss, delay and impact of each press, a change of tools (VHMR 4.4)",
       run_session},
      {"speed", "tennis_ball", "step(), times real time, wrapper over raw mj_step", run_speed},
      {"stiffness", "stiffness", "apparent over commanded stiffness, softest stable wall (VHMR Fig 3)",
       run_stiffness},
      {"structure", "tennis_ball", "hexapod on elastic legs: sag, modes, order of the integrator, cost",
       run_structure},
      {"switching", "keypad",
       "the nearest of many objects: right, without chatter, in time; keys, a hit ball, tiles and a drum",
       run_switching},
      {"synchrony", "synchrony",
       "the seen deflection against the felt one, three presses (VHMR Fig 13); fused, against the true tool",
       run_synchrony},
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
