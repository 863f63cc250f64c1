// `encounter calibrate tracker`: its options and its help.
#include "app/calibrate/calibrate.h"
#include "app/modules/own_modules.h"

namespace enc::app {

void add_tracker(CLI::App& calibrate, TrackerOptions& options, int& code) {
  CLI::App* command = calibrate.add_subcommand(
      "tracker",
      "find a tracker's bias, noise and latency, with intervals, from a log of a tool that the machine "
      "carries");
  command->footer("Example: encounter calibrate tracker log.csv --rate-Hz 1000");
  command
      ->add_option("log", options.log,
                   "CSV with time_s, tip_x_mm.., tool_x_mm.. as export writes, or a record of run")
      ->required();
  command->add_option("--rate-Hz", options.rate, "refuse logs with any other sample rate (Hz)");
  json_option(command, options.json);
  command->callback([&] { code = fit_module().tracker(options); });
}

}  // namespace enc::app
