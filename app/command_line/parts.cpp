#include "app/command_line/parts.h"

#include <charconv>
#include <string>

namespace enc::app {

// CLI11 reads "-1" and numbers of 30 digits as some other number.
std::string bad_seed(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, bad] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (bad == std::errc() && end == text.data() + text.size()) return {};
  return "expected a whole number from 0 to 18446744073709551615";
}

// "" is what a script gives whose variable is not set.
std::string unnamed(const std::string& text) {
  return text.empty() ? "expected a name, and this one is empty" : std::string();
}

void force_option(CLI::App* command, bool& force) {
  command->add_flag("--force", force, "replace files that are there");
}

void scene_options(CLI::App* command, SceneOptions& options) {
  command->add_option("scene", options.scene, "scene file, or the name of a shipped scene (encounter scenes)")
      ->required();
  command->add_option("--rig", options.rig, "rig: sim, a name in models/rigs, or a file")
      ->capture_default_str();
  command->add_option("--set", options.set,
                      "override, e.g. object.ball.radius_mm=30 (names: encounter params SCENE)");
  command->add_option("--seed", options.seed, "seed of all random streams")
      ->capture_default_str()
      ->check(bad_seed);
}

CLI::App* add_view(CLI::App& app, ViewOptions& options) {
  CLI::App* command = app.add_subcommand(
      "view",
      "run a scene in a window, where the mouse is the hand; or draw it into a file, as a picture or a film");
  scene_options(command, options);
  command->get_option("scene")->required(false)->description(
      "scene file, name of a shipped scene, or record; none: choose in the window");
  CLI::Option* record =
      command
          ->add_option("--record", options.record,
                       "of a window: write inputs and outputs of every tick, and the hand, to this file")
          ->check(unnamed);
  CLI::Option* shot = command->add_option("--shot", options.shot, "PNG file to write; no window is opened")
                          ->check(unnamed)
                          ->excludes(record);
  CLI::Option* video =
      command
          ->add_option("--video", options.video,
                       "film of the run to write; no window is opened. .mp4, .webm, .gif, .mkv or .mov where "
                       "ffmpeg is installed; without an ending, or without ffmpeg: a folder of PNGs")
          ->check(unnamed)
          ->excludes(record)
          ->excludes(shot);
  command
      ->add_option("--for-s", options.seconds,
                   "of a film: length, s of experiment; default: until the user or the probe is done")
      ->needs(video);
  command->add_option(
      "--at-s", options.at,
      "moment of the picture, s of experiment; default: the first press at its deepest, or 4 s through the "
      "camera. Of a film: where it begins; default: 0");
  CLI::Option* close_up =
      command->add_flag("--close-up", options.close_up, "the contact instead of the whole machine");
  command
      ->add_option(
          "--through-camera", options.through_camera,
          "of a picture: what the scene's left camera sees, not the world from beside: raw; removed, "
          "without the arm; or augmented, with the virtual objects in its place")
      ->check(CLI::IsMember({"raw", "removed", "augmented"}))
      ->excludes(close_up);
  device_options(command, options);
  force_option(command, options.force);
  return command;
}

CLI::App* add_tour(CLI::App& app, TourOptions& options) {
  CLI::App* command =
      app.add_subcommand("tour", "a film of each shipped scene, from a second before its first touch");
  command->add_option("--out", options.out, "folder for the films")->check(unnamed)->capture_default_str();
  command->add_option("--for-s", options.seconds, "length of each film, s of experiment")
      ->capture_default_str();
  force_option(command, options.force);
  return command;
}

CLI::App* add_calibrate(CLI::App& app, CalibrateOptions& options) {
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "a tracker's bias, noise and latency out of a log; the tip of a tool out of its swinging about it; the "
      "camera's pose out of pairs of points, or guided: the rig's simulated arm is driven through its view; "
      "a rig's tracker, force sensor and the weight on it, by a tool that its machine carries from pose to "
      "pose; "
      "a stereo head out of pictures of a chessboard; the colour of skin out of pictures of hands");
  command
      ->add_option(
          "what", options.log,
          "CSV with time_s, tip_x_mm.., tool_x_mm.. as export writes; or with time_s, tool_x_mm.., "
          "tool_qx..; or with camera_x_m.., device_x_m.., pair; a rig; "
          "a folder with left01.png, right01.png, ...; or, with --skin, a folder with images of hands")
      ->required();
  command->add_option("--rate-Hz", options.rate, "of a log: rows a second that it shall have; default: any");
  command->add_flag("--pivot", options.pivot,
                    "of a log with tip and markers, as export writes: where the swung tool's tip is");
  command->add_flag("--json", options.json, "one JSON object instead of text");
  command
      ->add_option(
          "--out", options.out,
          "of a rig: TOML that its [calibration] reads, or, with an arm, CSV to write the points to; of "
          "a folder: TOML")
      ->check(unnamed);
  command->add_option("--pairs", options.pairs, "of an arm: places of the tip; default: 8")
      ->check(CLI::Range(4, 1000));
  command->add_option("--frames", options.frames, "of an arm: averaged at each place; default: 20")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--seed", options.seed,
                   "of a rig: of the twin's noise; of points: of what is drawn from them; default: 1")
      ->check(bad_seed);
  command->add_option("--set", options.set, "of a rig: override, as for run");
  command->add_flag("--through-images", options.through_images,
                    "of an arm: a ball at the tip is found in pictures of the twin's camera; without "
                    "it the camera sees points");
  command
      ->add_option("--scene", options.scene,
                   "of a rig: whose clamped tool its machine carries; default: clamped_tool")
      ->check(unnamed);
  command->add_option("--poses", options.poses, "of a rig: in which the machine stands still; default: 24")
      ->check(CLI::Range(12, 500));
  device_options(command, options);
  command->add_option("--square-mm", options.square_mm, "of a chessboard: side of the board's squares");
  command->add_option("--corners", options.corners,
                      "of a chessboard: inner corners of the board; default: 9x6");
  command->add_option("--picture", options.picture, "of a chessboard: PNG of rectified pairs to write")
      ->check(unnamed);
  command
      ->add_option("--skin", options.skin,
                   "of hands: folder with a mask for each image, of the same name, white where the hand is")
      ->check(unnamed);
  force_option(command, options.force);
  return command;
}

CLI::App* add_shadow(CLI::App& app, ShadowOptions& options) {
  CLI::App* command = app.add_subcommand(
      "shadow",
      "feed a record to the twin: how far each channel is from what the twin says, with intervals and "
      "bounds; exit 1 where one diverges");
  command->add_option("record", options.record, "file written by run --record")->required();
  command->add_option("--set", options.set,
                      "override of the record's own set-up: the twin, e.g. truth.tracker.latency_ms=3.5");
  command->add_flag("--partial", options.partial, "what a cut-off record still holds");
  command->add_flag("--json", options.json, "one JSON object instead of text");
  return command;
}

}  // namespace enc::app
