// `encounter calibrate rig`: its options, its help, and how a person stops the machine.
#include <optional>

#include "app/calibrate/calibrate.h"
#include "app/common/command_options.h"
#include "app/modules/own_modules.h"
#include "trial/operator/operator.h"

namespace enc::app {
namespace {

// Any signal or key stops a machine that moves.
int run_rig(const RigOptions& options) {
  std::optional<trial::Operator> person;
  bool halted = false;
  RigOptions stoppable = options;
  stoppable.catch_signals = [&] {
    person.emplace();
    if (options.armed) person->stops_when_suspended();
    person->begin();
  };
  stoppable.confirm = [&](const std::string& question) {
    const bool yes = question.empty() || options.yes || person->confirm(question) == trial::Answer::yes;
    if (yes) person->listen();
    return yes;
  };
  stoppable.stop = [&] {
    halted = halted || (person && (person->next() == trial::Hand::halt || person->quits()));
    return halted || (person && person->stop());
  };
  const int code = fit_module().rig(stoppable, module_for_pictures);
  return person && person->signal() != 0 ? 128 + person->signal() : code;
}

}  // namespace

void add_rig(CLI::App& calibrate, RigOptions& options, int& code) {
  CLI::App* command = calibrate.add_subcommand(
      "rig",
      "find where a rig's tracker and force sensor are and what the sensor carries, from poses in which the "
      "machine holds a clamped tool");
  command->footer("Example: encounter calibrate rig sim --out measured.toml");
  command->add_option("rig", options.rig, "rig with a hexapod: a name in models/rigs, or a file")->required();
  command
      ->add_option("--scene", options.scene, "whose clamped tool the machine carries; default: clamped_tool")
      ->check(unnamed);
  command->add_option("--poses", options.poses, "in which the machine stands still; default: 24")
      ->check(CLI::Range(12, 500));
  command->add_option("--seed", options.seed, "of the twin's noise; default: 1")->check(bad_seed);
  command->add_option("--set", options.set, "override, as for run");
  device_options(command, options);
  command->add_option("--out", options.out, "TOML to write, which the rig's [calibration] reads")
      ->check(unnamed);
  force_option(command, options.force);
  json_option(command, options.json);
  command->callback([&] { code = run_rig(options); });
}

}  // namespace enc::app
