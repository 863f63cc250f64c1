#include "app/check/costs.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/modules/modules.h"
#include "app/process.h"
#include "core/base/counted.h"
#include "trial/trial.h"

namespace enc::app {
namespace {

constexpr double kRun = 0.25;  // s, of experiment

// Of the engine, for which this scene has no use.
std::string not_looked_for(const mjModel& model) {
  constexpr std::array<std::pair<int, const char*>, 3> kOff{
      {{mjDSBL_CONTACT, "contacts"}, {mjDSBL_CONSTRAINT, "constraints"}, {mjDSBL_ISLAND, "islands"}}};
  std::vector<std::string> off;
  for (const auto& [flag, word] : kOff)
    if ((model.opt.disableflags & flag) != 0) off.emplace_back(word);
  return off.empty() ? "" : fmt::format("; not looked for: {}", fmt::join(off, ", "));
}

std::string physics_text(const sim::Physics& physics) {
  const mjModel& m = *physics.model();
  return fmt::format("  physics   {} MuJoCo elements: {} bodies, {} joints, {} geoms, {} sensors{}\n",
                     physics.elements(), m.nbody, m.njnt, m.ngeom, m.nsensor, not_looked_for(m));
}

bool among(const std::vector<std::string>& libraries, const std::string& part) {
  return std::any_of(libraries.begin(), libraries.end(),
                     [&](const std::string& name) { return name.find(part) != std::string::npos; });
}

// As the kernel tells it.
std::string process_text() {
  const std::vector<std::string> libraries = mapped_libraries();
  std::vector<std::string> loaded, left;
  for (const std::string& library : libraries)  // in whichever folder it stood
    if (const std::string name = module_name(library); !name.empty()) loaded.push_back(name);
  for (const std::string& name : modules_there())
    if (std::find(loaded.begin(), loaded.end(), name) == loaded.end()) left.push_back(name);
  const bool gl = among(libraries, "libGL") || among(libraries, "libEGL") || among(libraries, "libOSMesa");
  const int threads = thread_count();
  return fmt::format(
      "  process   {}, {} libraries, {:.0f} MiB at most so far; OpenGL {}; modules {}; not loaded "
      "{}\n",
      counted(threads, "thread"), libraries.size(), peak_memory_mb(), gl ? "loaded" : "not loaded",
      loaded.empty() ? "none" : fmt::format("{}", fmt::join(loaded, ", ")),
      left.empty() ? "none" : fmt::format("{}", fmt::join(left, ", ")));
}

}  // namespace

std::string costs_text(const models::Setup& setup, std::uint64_t seed, double ready) {
  const trial::Slots slots = trial::slots_of(setup);
  if (slots.real || !slots.simulated)
    return "\ncosts       not measured: not all devices of this rig are simulated\n";
  for (const char* module : {"camera", "vision"})
    if (setup.scene.camera && !module_there(module))
      return fmt::format("\ncosts       not measured: the module {} is not built\n", module);
  trial::TrialOptions options;
  options.seed = seed;
  options.seconds = kRun;
  options.drivers = load_module;
  const double before = cpu_seconds();
  trial::Trial trial(setup, options);
  const double built = cpu_seconds();
  const trial::TrialResult result = trial.run();
  const double tick = (cpu_seconds() - built) / static_cast<double>(result.ticks);
  return fmt::format(
             "\ncosts       ready after {:.0f} ms of CPU time; a tick takes {:.1f} us: {:.3g} x real time "
             "(its first {:g} s)\n",
             (ready + built - before) * 1e3, tick * 1e6, 1.0 / (tick * setup.rig.loop.rate), kRun) +
         physics_text(trial.world().physics()) + process_text();
}

}  // namespace enc::app
