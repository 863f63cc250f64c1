#include <array>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

// Each benchmark is a folder and a namespace.
namespace deformation {
BenchResult run(const BenchContext& context);
}
namespace dent {
BenchResult run(const BenchContext& context);
}
namespace encounter {
BenchResult run(const BenchContext& context);
}
namespace footprint {
BenchResult run(const BenchContext& context);
}
namespace gravity {
BenchResult run(const BenchContext& context);
}
namespace indentation {
BenchResult run(const BenchContext& context);
}
namespace press {
BenchResult run(const BenchContext& context);
}
namespace session {
BenchResult run(const BenchContext& context);
}
namespace stiffness {
BenchResult run(const BenchContext& context);
}
namespace structure {
BenchResult run(const BenchContext& context);
}
namespace workspace {
BenchResult run(const BenchContext& context);
}
namespace identification {
BenchResult run(const BenchContext& context);
}
namespace reaching {
BenchResult run(const BenchContext& context);
}
namespace plane_button {
BenchResult run(const BenchContext& context);
}
namespace registration {
BenchResult run(const BenchContext& context);
}
namespace response {
BenchResult run(const BenchContext& context);
}
namespace mesh {
BenchResult run(const BenchContext& context);
}
namespace nearest {
BenchResult run(const BenchContext& context);
}
namespace synchrony {
BenchResult run(const BenchContext& context);
}
namespace switching {
BenchResult run(const BenchContext& context);
}
namespace tracking {
BenchResult run(const BenchContext& context);
}
namespace speed {
BenchResult run(const BenchContext& context);
}

std::span<const Benchmark> benchmarks() {
  static constexpr auto kAll = std::to_array<Benchmark>({
      {"dent", "tennis_ball",
       "the seen surface: contact vertex, volume, time of an update of 10,242 vertices", dent::run},
      {"deformation", "tennis_ball", "the seen ball's contour against that of a pressed ball (VHMR Fig 11)",
       deformation::run},
      {"encounter", "tennis_ball",
       "distance from the true tool tip to the haptic-tip at first touch, over approach speed",
       encounter::run},
      {"footprint", "all", "libraries, threads, memory and start of each scene that ships", footprint::run},
      {"gravity", "wall",
       "gravity compensation of the arm: residual force over the workspace, catalogue, race against KDL "
       "(VisHap eq. 5)",
       gravity::run},
      {"identification", "rig_identify",
       "injected ball parameters out of a rig's loops: are they in the intervals, how wide are these",
       identification::run},
      {"indentation", "indentation",
       "a hand replicates indentations A, B, C on the virtual ball (VHMR Figs 8 and 10, Table 2); "
       "directions, lag",
       indentation::run},
      {"press", "tennis_ball", "one contact for each press, limit held, tip inside, no pull", press::run},
      {"reaching", "wall",
       "is the prop there before the finger, how far beside it and how hard do they meet (VisHap 2.2)",
       reaching::run},
      {"registration", "vishap",
       "camera and arm from pairs of places: error per axis, pairs and frames, time (VisHap 2.2)",
       registration::run},
      {"plane_button", "wall",
       "force over distance, wall and button (VisHap Figs 4, 5); late finger, step, limits",
       plane_button::run},
      {"response", "tennis_ball", "both response models: minor loops, jumps, tremor at rest, energy",
       response::run},
      {"mesh", "tennis_ball", "a ball of a million triangles: from file to tree, and step() on it",
       mesh::run},
      {"nearest", "geodesic ball", "nearest point on a mesh: time, growth, jumps, race against Embree",
       nearest::run},
      {"session", "session",
       "a user's two minutes: contacts, miss, delay and impact of each press, a change of tools (VHMR 4.4)",
       session::run},
      {"speed", "tennis_ball", "step(), times real time, wrapper over raw mj_step", speed::run},
      {"stiffness", "stiffness", "apparent over commanded stiffness, softest stable wall (VHMR Fig 3)",
       stiffness::run},
      {"structure", "tennis_ball", "hexapod on elastic legs: sag, modes, order of the integrator, cost",
       structure::run},
      {"switching", "keypad",
       "the nearest of many objects: right, without chatter, in time; keys, a hit ball, tiles and a drum",
       switching::run},
      {"synchrony", "synchrony",
       "the seen deflection against the felt one, three presses (VHMR Fig 13); fused, against the true tool",
       synchrony::run},
      {"tracking", "tracking",
       "the tracker against the machine that carries the tool (VHMR Table 1); latency of a log; prediction",
       tracking::run},
      {"workspace", "tennis_ball",
       "box and volume of the tip's travel, tracker's volume, directions from which the ball can be pressed",
       workspace::run},
  });
  return kAll;
}

}  // namespace enc::bench
