// The scene of a benchmark, with the user's settings in it, and the modules that it may need.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/assemble.h"

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

// The modules of the program, for TrialOptions::drivers; `context` outlives it.
[[nodiscard]] inline trial::DriverSource modules_of(const BenchContext& context) {
  return [&context](const std::string& name) -> const ModuleInfo& {
    const ModuleInfo* module = context.module(name);
    if (module == nullptr) throw Error("the module " + name + " is not built", {}, ErrorKind::device);
    return *module;
  };
}

}  // namespace enc::bench
