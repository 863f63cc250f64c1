#include "benchmarks/kit/scenes.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "benchmarks/kit/entry.h"
#include "core/base/error.h"
#include "core/devices/mode.h"
#include "trial/operator/operator.h"

namespace enc::bench {

models::Setup load_scene(const BenchContext& context, const std::string& name, std::vector<std::string> own,
                         const std::vector<std::string>& held) {
  const std::vector<std::string> users = settings_for(context, name, held);
  own.insert(own.end(), users.begin(), users.end());
  own.insert(own.end(), held.begin(), held.end());
  return models::load(context.models + "/scenes/" + name + ".toml", {}, own);
}

RigScene on_rig(const BenchContext& context, const std::string& name, std::vector<std::string> own,
                const std::vector<std::string>& held) {
  RigScene on{context.models + "/scenes/" + name + ".toml", std::move(own), {}};
  on.set.insert(on.set.end(), context.set.begin(), context.set.end());
  on.set.insert(on.set.end(), held.begin(), held.end());
  on.setup = models::load(on.scene, context.rig, on.set);
  if (trial::slots_of(on.setup).machine && !context.armed)
    throw Error(
        fmt::format("--rig: the machine of {} is told nothing without --armed, and does nothing that could "
                    "be measured; add it, or name another rig",
                    on.setup.rig_path));
  if (context.armed && context.confirm && attended(context, on.setup) && trial::moves_device(on.setup))
    context.confirm(trial::motion_question(on.setup, trial::prepare_setup(on.setup), {}));
  return on;
}

trial::TrialOptions rig_options(const BenchContext& context) {
  trial::TrialOptions options = twin_options(context);
  options.drivers = modules_of(context);
  options.armed = context.armed;
  options.lockstep = context.lockstep;
  options.real_time = context.armed && !context.lockstep;
  options.needs_real_time = !context.not_real_time;
  return options;
}

trial::TrialOptions twin_options(const BenchContext& context) { return {.stop = context.stop}; }

bool attended(const BenchContext& context, const models::Setup& setup) {
  return trial::slots_of(setup).real && !context.fakes && !context.lockstep;
}

void tell(const std::string& line) {
  if (isatty(STDERR_FILENO) != 0)
    fmt::print(stderr, "\r{:78}\n", line);
  else
    fmt::print(stderr, "{}\n", line);
}

std::unique_ptr<Companion> begun_fakes(std::vector<std::string> words) {
  constexpr double kLongest = 60.0;  // s: a busy machine, and the checks of a sanitizer
  words.insert(words.begin(), {this_program(), "fake"});
  return std::make_unique<Companion>(std::move(words), "ends with SIGINT or SIGTERM", kLongest);
}

std::unique_ptr<Companion> fakes_of(const BenchContext& context, const RigScene& on, std::uint64_t seed,
                                    const std::vector<std::string>& more) {
  if (!context.fakes) return nullptr;
  std::vector<std::string> words{context.rig, "--scene", on.scene, "--seed", std::to_string(seed)};
  if (context.lockstep) words.emplace_back("--lockstep");
  for (const auto* settings : {&on.set, &more})
    for (const std::string& set : *settings) words.insert(words.end(), {"--set", set});
  return begun_fakes(std::move(words));
}

std::string rig_text(const BenchContext& context, const models::Setup& setup) {
  std::string text = "rig " + setup.rig_path;
  if (context.fakes) text += ", fakes of its devices";
  if (context.lockstep) text += " in lockstep";
  return text;
}

void check_ended(const trial::Trial& trial) {
  if (!trial.gate().links().empty()) {
    const trial::LostLink& link = trial.gate().links().front();
    throw Error(fmt::format("the {} was lost at {:.3f} s of a run, and what that has measured is worth "
                            "nothing; see to it (encounter devices), and begin anew",
                            link.role, seconds(link.t.time_since_epoch())),
                {}, ErrorKind::device);
  }
  if (trial.result().interrupted) throw Error("the run was interrupted", {}, ErrorKind::device);
}

std::string held_in(const trial::Trial& trial) {
  // Before the first samples there is no input to judge.
  constexpr Time kBegun{Duration(100'000'000)};
  const auto text = [](const char* when, Time t, std::uint32_t why) {
    return fmt::format("the run {} at {:.3f} s: {}", when, seconds(t.time_since_epoch()), why_text(why));
  };
  for (const auto& [t, why] : trial.result().holds)
    if (t > kBegun) return text("held", t, why);
  // A hold that began earlier, or that is no longer in the list.
  const auto& [t, why] = trial.result().last_hold;
  return t > kBegun ? text("was in hold", t, why) : std::string();
}

void refuse_held(const std::string& held) {
  if (!held.empty())
    throw Error(
        held +
            "; what it has measured is worth nothing; see docs/guide/troubleshooting.md for what to do, "
            "and begin anew",
        {}, ErrorKind::device);
}

}  // namespace enc::bench
