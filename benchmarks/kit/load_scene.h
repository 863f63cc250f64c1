// The scene of a benchmark, with the user's settings in it.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "models/setup/scene_file.h"

namespace enc::bench {

// models/scenes/<name>.toml on the simulated rig that it names. Of two settings the later one wins: `own` are
// the benchmark's, then come the user's, then those that a comparison must hold.
[[nodiscard]] inline models::Setup load_scene(const BenchContext& context, const std::string& name,
                                              std::vector<std::string> own = {},
                                              const std::vector<std::string>& held = {}) {
  own.insert(own.end(), context.set.begin(), context.set.end());
  own.insert(own.end(), held.begin(), held.end());
  return models::load(context.models + "/scenes/" + name + ".toml", {}, own);
}

}  // namespace enc::bench
