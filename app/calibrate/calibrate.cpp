#include "app/calibrate/calibrate.h"

#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/schema/wording.h"

namespace enc::app {

void add_calibrate(CLI::App& app, CalibrateWords& words, int& code) {
  CLI::App* command =
      app.add_subcommand("calibrate", "calibrate one subject: tracker, tip, camera, rig, stereo or skin");
  command->require_subcommand(1);
  command->footer("Example: encounter calibrate tracker log.csv");
  add_tracker(*command, words.tracker, code);
  add_tip(*command, words.tip, code);
  add_camera(*command, words.camera, code);
  add_rig(*command, words.rig, code);
  add_stereo(*command, words.stereo, code);
  add_skin(*command, words.skin, code);
}

void check_folder(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code none;
  if (fs::is_directory(folder, none)) return;
  const bool there = fs::exists(folder, none);
  const std::string ending = models::lower_case(fs::path(folder).extension().string());
  if (there && (ending == ".png" || ending == ".jpg" || ending == ".jpeg"))
    throw Error(fmt::format(
        "{}: is a single image; expected the folder that all of them are in; give its name", folder));
  throw Error(fmt::format("{}: is {}; expected a folder of images; see to its name", folder,
                          there ? "a file" : "not there"));
}

}  // namespace enc::app
