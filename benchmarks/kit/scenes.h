// The scene of a benchmark with the settings of the user in it, the modules that it may need, and what it
// needs to measure over the devices of a rig in place of the twin: the options of its runs, and fakes of the
// devices.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/child.h"
#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/assemble.h"
#include "trial/trial.h"

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

// A scene on the user's rig, and the settings that made it so: `encounter fake` is told the same.
struct OnRig {
  std::string scene;  // file
  std::vector<std::string> set;
  models::Setup setup;
};
// models/scenes/<name>.toml; settings in the order of load_scene(). Throws Error where the rig's machine
// would be told nothing.
[[nodiscard]] OnRig on_rig(const BenchContext& context, const std::string& name, std::vector<std::string> own,
                           const std::vector<std::string>& held = {});

// Of runs over the devices, and of the same in the twin. `context` outlives them.
[[nodiscard]] trial::TrialOptions rig_options(const BenchContext& context);
[[nodiscard]] trial::TrialOptions twin_options(const BenchContext& context);

// Somebody stands at the machine: its devices are no fakes of ours.
[[nodiscard]] bool attended(const BenchContext& context, const models::Setup& setup);
// A line for who does, on standard error, where the bar of progress is.
void tell(const std::string& line);

// `encounter fake` with these words, until it goes.
[[nodiscard]] std::unique_ptr<Companion> begun_fakes(std::vector<std::string> words);
// The same in place of the devices; null where the user does not want it. `more`: settings of its own.
[[nodiscard]] std::unique_ptr<Companion> fakes_of(const BenchContext& context, const OnRig& on,
                                                  std::uint64_t seed,
                                                  const std::vector<std::string>& more = {});

// "rig models/rigs/fakes.toml, fakes of its devices in lockstep"
[[nodiscard]] std::string rig_text(const BenchContext& context, const models::Setup& setup);

// Of a run that is over. Throws Error (kind device) where that was not its own end: what it has measured is
// no measure.
void check_ended(const trial::Trial& trial);
// When a run held and why, after the first 0.1 s; empty: it did not. Over devices nothing is measured then:
// refuse_held() throws Error (kind device).
[[nodiscard]] std::string held_in(const trial::Trial& trial);
void refuse_held(const std::string& held);

}  // namespace enc::bench
