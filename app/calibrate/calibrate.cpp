// `encounter calibrate SUBJECT`: the options and the help of each subject.
#include "app/calibrate/calibrate.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "app/common/command_options.h"
#include "app/modules/modules.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "trial/operator/operator.h"

namespace enc::app {
namespace {

// Throws Error if a folder of images is expected and the path is missing or something else.
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

void add_tracker(CLI::App& calibrate, TrackerOptions& options, int& code) {
  CLI::App* command = add_command(calibrate, "tracker",
                                  "Find a tracker's bias, noise and latency, with confidence intervals, from "
                                  "a log of a tool that the machine carries.",
                                  "calibrate tracker log.csv --rate-Hz 1000");
  command
      ->add_option("log", options.log,
                   "CSV with time_s, tip_x_mm.., tool_x_mm.. as export writes, or a record of run")
      ->required();
  command->add_option("--rate-Hz", options.rate, "refuse logs with any other sample rate (Hz)");
  json_option(command, options.json);
  command->callback([&] { code = fit_module().tracker(options); });
}

void add_tip(CLI::App& calibrate, TipOptions& options, int& code) {
  CLI::App* command = add_command(
      calibrate, "tip", "Find a tool's tip in its markers' frame from a log of the tool pivoting about it.",
      "calibrate tip poses.csv");
  command
      ->add_option("log", options.log,
                   "CSV with time_s, tool_x_mm.., tool_qx.. or, as export writes, with time_s, "
                   "markers_x_mm.., markers_qx..; or a record of run")
      ->required();
  json_option(command, options.json);
  command->callback([&] { code = fit_module().tip(options); });
}

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

void add_camera(CLI::App& calibrate, CameraOptions& options, int& code) {
  CLI::App* command = add_command(calibrate, "camera",
                                  "Find a camera's pose from pairs of points, or by moving a rig's simulated "
                                  "arm through the camera's view.",
                                  "calibrate camera vishap --pairs 8 --out points.csv");
  command
      ->add_option(
          "what", options.what,
          "CSV with camera_x_m.., device_x_m.., pair; or a rig with an arm: a name in models/rigs, or "
          "a file")
      ->required();
  command->add_option("--pairs", options.pairs, "rig only: number of tip positions; default: 8")
      ->check(CLI::Range(4, 1000));
  command->add_option("--frames", options.frames, "rig only: frames averaged at each position; default: 20")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--seed", options.seed,
                   "rig: seed of the twin's noise; points: seed of the random samples of points; default: 1")
      ->check(bad_seed);
  command->add_option("--set", options.set, "rig only: override, as for run");
  command->add_flag(
      "--through-images", options.through_images,
      "rig only: find a ball at the tip in images of the twin's camera; default: the camera measures points");
  command->add_option("--out", options.out, "rig only: CSV file to write, with the points")
      ->check(bad_output);
  force_option(command, options.force);
  json_option(command, options.json);
  command->callback([&] {
    check_camera(options);
    code = fit_module().camera(options, module_for_pictures);
  });
}

// Any signal or key stops a moving machine.
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

void add_rig(CLI::App& calibrate, RigOptions& options, int& code) {
  CLI::App* command = add_command(
      calibrate, "rig",
      "Find a rig's tracker pose, force sensor rotation and mass on the sensor, from poses in which the "
      "machine holds a clamped tool. With --armed the machine moves by itself for minutes.",
      "calibrate rig sim --out measured.toml");
  command->add_option("rig", options.rig, "rig with a hexapod: a name in models/rigs, or a file")->required();
  command
      ->add_option("--scene", options.scene,
                   "scene whose clamped tool the machine carries; default: clamped_tool")
      ->check(unnamed);
  command->add_option("--poses", options.poses, "number of poses in which the machine stops; default: 24")
      ->check(CLI::Range(12, 500));
  command->add_option("--seed", options.seed, "seed of the twin's noise; default: 1")->check(bad_seed);
  command->add_option("--set", options.set, "override, as for run");
  device_options(command, options);
  command->add_option("--out", options.out, "TOML to write, which the rig's [calibration] reads")
      ->check(bad_output);
  force_option(command, options.force);
  json_option(command, options.json);
  command->callback([&] { code = run_rig(options); });
}

void add_stereo(CLI::App& calibrate, StereoOptions& options, int& code) {
  CLI::App* command =
      add_command(calibrate, "stereo", "Calibrate a stereo head from pairs of images of a chessboard.",
                  "calibrate stereo images --square-mm 25 --out head.toml");
  command->add_option("folder", options.folder, "folder with left01.png, right01.png, ...")->required();
  command->add_option("--square-mm", options.square_mm, "side of the board's squares, as measured");
  command->add_option("--corners", options.corners, "inner corners of the board")->capture_default_str();
  command->add_option("--picture", options.picture, "PNG of rectified pairs to write")->check(bad_output);
  command->add_option("--out", options.out, "TOML to write, which a rig's [camera] reads")->check(bad_output);
  force_option(command, options.force);
  json_option(command, options.json);
  command->callback([&] {
    check_folder(options.folder);
    code = calibration_module().stereo(options);
  });
}

void add_skin(CLI::App& calibrate, SkinOptions& options, int& code) {
  CLI::App* command =
      add_command(calibrate, "skin", "Fit the colour of skin to images of hands and their masks.",
                  "calibrate skin images --masks masks --out skin.toml");
  command->add_option("folder", options.folder, "folder with images of hands")->required();
  command
      ->add_option("--masks", options.masks,
                   "folder with a mask for each image, of the same name, white where the hand is")
      ->required()
      ->check(unnamed);
  command->add_option("--out", options.out, "TOML to write, with the lines for a rig's [vision]")
      ->check(bad_output);
  force_option(command, options.force);
  json_option(command, options.json);
  command->callback([&] {
    check_folder(options.folder);
    code = calibration_module().skin(options);
  });
}

}  // namespace

void add_calibrate(CLI::App& app, CalibrateWords& words, int& code) {
  CLI::App* command =
      add_command(app, "calibrate", "Calibrate a tracker, tool tip, camera, rig, stereo head or skin colour.",
                  "calibrate tracker log.csv");
  command->require_subcommand(1);
  add_tracker(*command, words.tracker, code);
  add_tip(*command, words.tip, code);
  add_camera(*command, words.camera, code);
  add_rig(*command, words.rig, code);
  add_stereo(*command, words.stereo, code);
  add_skin(*command, words.skin, code);
}

}  // namespace enc::app
