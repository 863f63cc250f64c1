// The scene of a benchmark with the user's settings and the modules that it may need. Also the tools to
// measure over the devices of a rig in place of the twin: the options of its runs, and fakes of the devices.
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

// Loads models/scenes/<name>.toml on the simulated rig that it names. A later setting overrides an earlier
// one: first `own`, the benchmark's; then the user's; then those that a comparison must hold.
// Settings for another scene of the benchmark stay out (entry.h).
[[nodiscard]] models::Setup load_scene(const BenchContext& context, const std::string& name,
                                       std::vector<std::string> own = {},
                                       const std::vector<std::string>& held = {});

// The modules of the program, for TrialOptions::drivers; `context` must outlive it.
[[nodiscard]] inline trial::DriverSource modules_of(const BenchContext& context) {
  return [&context](const std::string& name) -> const ModuleInfo& {
    const ModuleInfo* module = context.module(name);
    if (module == nullptr) throw Error("the module " + name + " is not built", {}, ErrorKind::device);
    return *module;
  };
}

// A scene on the user's rig, and the settings that made it so: `encounter fake` gets these settings as well.
struct RigScene {
  std::string scene;  // file
  std::vector<std::string> set;
  models::Setup setup;
};
// Loads models/scenes/<name>.toml; settings in the order of load_scene(). Throws Error if the rig's machine
// would receive no command.
[[nodiscard]] RigScene on_rig(const BenchContext& context, const std::string& name,
                              std::vector<std::string> own, const std::vector<std::string>& held = {});

// Options of runs over the devices, and of their twins. `context` must outlive them.
[[nodiscard]] trial::TrialOptions rig_options(const BenchContext& context);
[[nodiscard]] trial::TrialOptions twin_options(const BenchContext& context);

// Reports whether a person may stand at the machine: its devices are not our fakes.
[[nodiscard]] bool attended(const BenchContext& context, const models::Setup& setup);
// Prints a line for that person on standard error, where the bar of progress is.
void tell(const std::string& line);

// `encounter fake` with these words; it runs until the object is destroyed.
[[nodiscard]] std::unique_ptr<Companion> begun_fakes(std::vector<std::string> words);
// Fakes in place of the devices; null if the user does not want them. `more`: additional settings.
[[nodiscard]] std::unique_ptr<Companion> fakes_of(const BenchContext& context, const RigScene& on,
                                                  std::uint64_t seed,
                                                  const std::vector<std::string>& more = {});

// "rig models/rigs/fakes.toml, fakes of its devices in lockstep"
[[nodiscard]] std::string rig_text(const BenchContext& context, const models::Setup& setup);

// Checks a run that has ended. Throws Error (kind device) if it ended early, because its measurements are
// then invalid.
void check_ended(const trial::Trial& trial);
// Time and reason of a hold after the first 0.1 s; empty: the run did not hold. A hold over devices makes the
// measurement invalid: refuse_held() throws Error (kind device).
[[nodiscard]] std::string held_in(const trial::Trial& trial);
void refuse_held(const std::string& held);

}  // namespace enc::bench
