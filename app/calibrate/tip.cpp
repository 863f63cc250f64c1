// `encounter calibrate tip`: its options and its help.
#include "app/calibrate/calibrate.h"
#include "app/modules/own_modules.h"

namespace enc::app {

void add_tip(CLI::App& calibrate, TipOptions& options, int& code) {
  CLI::App* command = calibrate.add_subcommand(
      "tip",
      "find where a tool's tip is in its markers from a log of the tool while you swing it about its tip");
  command->footer("Example: encounter calibrate tip poses.csv");
  command
      ->add_option("log", options.log,
                   "CSV with time_s, tool_x_mm.., tool_qx.. or, as export writes, with time_s, "
                   "markers_x_mm.., markers_qx..; or a record of run")
      ->required();
  json_option(command, options.json);
  command->callback([&] { code = fit_module().tip(options); });
}

}  // namespace enc::app
