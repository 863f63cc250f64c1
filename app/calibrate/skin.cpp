// `encounter calibrate skin`: its options and its help.
#include "app/calibrate/calibrate.h"
#include "app/common/command_options.h"
#include "app/modules/own_modules.h"

namespace enc::app {

void add_skin(CLI::App& calibrate, SkinOptions& options, int& code) {
  CLI::App* command =
      calibrate.add_subcommand("skin", "learn the colour of skin from images of hands and their masks");
  command->footer("Example: encounter calibrate skin images --masks masks --out skin.toml");
  command->add_option("folder", options.folder, "folder with images of hands")->required();
  command
      ->add_option("--masks", options.masks,
                   "folder with a mask for each image, of the same name, white where the hand is")
      ->required()
      ->check(unnamed);
  command->add_option("--out", options.out, "TOML to write, the lines of a rig's [vision]")->check(unnamed);
  force_option(command, options.force);
  json_option(command, options.json);
  command->callback([&] {
    check_folder(options.folder);
    code = calibration_module().skin(options);
  });
}

}  // namespace enc::app
