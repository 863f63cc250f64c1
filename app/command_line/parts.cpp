#include "app/command_line/parts.h"

#include <string>

#include "app/common/command_options.h"

namespace enc::app {
namespace {

// Of a view that draws into a file.
void drawing_options(CLI::App* command, ViewOptions& options, CLI::Option* record) {
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
}

}  // namespace

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
  drawing_options(command, options, record);
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

CLI::App* add_shadow(CLI::App& app, ShadowOptions& options) {
  CLI::App* command = app.add_subcommand(
      "shadow",
      "feed a record to the twin: how far each channel is from what the twin says, with intervals and "
      "bounds; exit 1 where one diverges");
  command->add_option("record", options.record, "file written by run --record")->required();
  command->add_option("--set", options.set,
                      "override of the record's own set-up: the twin, e.g. truth.tracker.latency_ms=3.5");
  command->add_flag("--partial", options.partial, "what a cut-off record still holds");
  json_option(command, options.json);
  return command;
}

}  // namespace enc::app
