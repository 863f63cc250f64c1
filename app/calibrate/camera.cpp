// `encounter calibrate camera`: its options and its help.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "app/calibrate/calibrate.h"
#include "app/common/command_options.h"
#include "app/modules/own_modules.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"

namespace enc::app {
namespace {

void check_camera(const CameraOptions& options) {
  const std::vector<std::string> rigs = models::files_in(models::models_dir(), "rigs");
  const std::filesystem::path what = options.what;
  const std::string ending = models::lower_case(what.extension().string());
  std::error_code none;
  const bool rig = std::find(rigs.begin(), rigs.end(), options.what) != rigs.end();
  if (rig || std::filesystem::exists(what, none) || ending == ".csv" || ending == ".toml") return;
  throw Error(fmt::format("{}: is not there; expected pairs of points (CSV) or a rig; {}", options.what,
                          models::advice(options.what, rigs)));
}

}  // namespace

void add_camera(CLI::App& calibrate, CameraOptions& options, int& code) {
  CLI::App* command = calibrate.add_subcommand(
      "camera",
      "find a camera's pose from pairs of points, or from a rig's simulated arm that is driven through the "
      "camera's view");
  command->footer("Example: encounter calibrate camera vishap --pairs 8 --out points.csv");
  command
      ->add_option(
          "what", options.what,
          "CSV with camera_x_m.., device_x_m.., pair; or a rig with an arm: a name in models/rigs, or "
          "a file")
      ->required();
  command->add_option("--pairs", options.pairs, "of a rig: places of the tip; default: 8")
      ->check(CLI::Range(4, 1000));
  command->add_option("--frames", options.frames, "of a rig: frames averaged at each place; default: 20")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--seed", options.seed,
                   "of a rig: of the twin's noise; of points: of what is drawn from them; default: 1")
      ->check(bad_seed);
  command->add_option("--set", options.set, "of a rig: override, as for run");
  command->add_flag(
      "--through-images", options.through_images,
      "of a rig: find a ball at the tip in pictures of the twin's camera; without it the camera "
      "sees points");
  command->add_option("--out", options.out, "of a rig: CSV to write the points to")->check(unnamed);
  force_option(command, options.force);
  json_option(command, options.json);
  command->callback([&] {
    check_camera(options);
    code = fit_module().camera(options, module_for_pictures);
  });
}

}  // namespace enc::app
