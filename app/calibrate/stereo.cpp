// `encounter calibrate stereo`: its options and its help.
#include "app/calibrate/calibrate.h"
#include "app/common/command_options.h"
#include "app/modules/own_modules.h"

namespace enc::app {

void add_stereo(CLI::App& calibrate, StereoOptions& options, int& code) {
  CLI::App* command =
      calibrate.add_subcommand("stereo", "calibrate a stereo head from pairs of images of a chessboard");
  command->footer("Example: encounter calibrate stereo images --square-mm 25 --out head.toml");
  command->add_option("folder", options.folder, "folder with left01.png, right01.png, ...")->required();
  command->add_option("--square-mm", options.square_mm, "side of the board's squares; measure them");
  command->add_option("--corners", options.corners, "inner corners of the board")->capture_default_str();
  command->add_option("--picture", options.picture, "PNG of rectified pairs to write")->check(unnamed);
  command->add_option("--out", options.out, "TOML to write, which a rig's [camera] reads")->check(unnamed);
  force_option(command, options.force);
  json_option(command, options.json);
  command->callback([&] {
    check_folder(options.folder);
    code = calibration_module().stereo(options);
  });
}

}  // namespace enc::app
