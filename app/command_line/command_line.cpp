// The command line. Each subcommand is one function in a file of its own (options.h). Exit codes: 0 yes, 1
// the answer is no, 2 the words or files are wrong, 3 a device, 4 ended in hold or diverged; 129, 130, 131
// and 143 after a clean end by SIGHUP, SIGINT, SIGQUIT and SIGTERM.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/calibrate/calibrate.h"
#include "app/common/command_options.h"
#include "app/common/options.h"
#include "app/laboratory/fakes.h"
#include "app/process.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "trial/provenance/provenance.h"

namespace enc::app {
namespace {

// Options of a view that draws into a file.
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

CLI::App* add_run(CLI::App& app, RunOptions& options) {
  CLI::App* command = app.add_subcommand("run", "run a scene and say what happened");
  scene_options(command, options);
  command->add_option("--pace", options.pace, "free, wall, or seconds of experiment per second of wall time")
      ->capture_default_str();
  command->add_option("--for-s", options.seconds,
                      "length, s of experiment; default: until the user or the probe is done");
  command->add_option("--record", options.record, "write inputs and outputs of every tick to this file")
      ->check(unnamed);
  command
      ->add_option("--frames", options.frames,
                   "keep what the scene's camera sees in this new folder, as PNG images")
      ->check(unnamed);
  command
      ->add_option("--hand", options.hand,
                   "record of a view: the hand that was steered there moves, for as long as it did")
      ->check(unnamed);
  json_option(command, options.json);
  device_options(command, options);
  force_option(command, options.force);
  return command;
}

CLI::App* add_check(CLI::App& app, CheckOptions& options) {
  CLI::App* command = app.add_subcommand(
      "check",
      "read a scene and its rig, find their mistakes, and say what will be built, what is left out and why, "
      "where each frame is, how hard and how soft an object may be, what it costs; no device moves (the twin "
      "runs for 0.25 s)");
  scene_options(command, options);
  CLI::Option* resolved = command->add_flag(
      "--resolved", options.resolved, "print the scene with only what it builds, as a scene file that runs");
  CLI::Option* advise = command->add_flag(
      "--advise", options.advise,
      "also run it at several time steps and integrators of its twin (about a minute) and name the "
      "cheapest that errs by no more than --error-N, --error-um");
  advise->excludes(resolved);
  command
      ->add_option("--error-N", options.error_N,
                   "of --advise: error of the true force, N rms while something touches")
      ->needs(advise);
  command->add_option("--error-um", options.error_um, "of --advise: error of the tip's path, um rms")
      ->needs(advise);
  return command;
}

CLI::App* add_fake(CLI::App& app, LaboratoryOptions& options) {
  CLI::App* command = app.add_subcommand(
      "fake",
      "stand in for the devices of a rig: serve their wires from one simulated world, until it is told "
      "to end");
  command->add_option("rig", options.rig, "a name in models/rigs, or a file")->required();
  command->add_option("--scene", options.scene, "what happens there; default: the tennis ball")
      ->check(unnamed);
  command->add_option("--set", options.set, "override, as for run");
  command->add_option("--seed", options.seed, "of all noise")->check(bad_seed);
  command->add_flag("--lockstep", options.lockstep,
                    "time goes on by a period with each set-point, and not by itself (run --lockstep)");
  command->add_option("--fault", options.faults,
                      "DRIVER:FAULT[=V][@TIME][+TIME], such as gcs:stall@3s+500ms: what goes wrong, when "
                      "after somebody came, and for how long; again for more. Faults: " +
                          fault_examples() + ". The same on a line of standard input: now; 'heal' ends all");
  return command;
}

CLI::App* add_devices(CLI::App& app, LaboratoryOptions& options) {
  CLI::App* command = app.add_subcommand(
      "devices",
      "ask the devices of a rig: what answers, how often, how regularly and how late; nothing moves");
  command->add_option("rig", options.rig, "a name in models/rigs, or a file")->required();
  command->add_option("--scene", options.scene, "whose devices; default: the tennis ball's")->check(unnamed);
  command->add_option("--set", options.set, "override, as for run");
  command->add_option("--for-s", options.seconds, "how long each is read")->capture_default_str();
  return command;
}

CLI::App* add_replay(CLI::App& app, ReplayOptions& options) {
  CLI::App* command =
      app.add_subcommand("replay", "run step() again over a record; exit 1 where outputs differ");
  command->add_option("record", options.record, "file written by run --record")->required();
  command
      ->add_option("--frames", options.frames,
                   "folder of run --frames: vision looks at it again; exit 1 where it tells something else")
      ->check(unnamed);
  command->add_flag("--partial", options.partial, "replay what a cut-off record still holds");
  return command;
}

CLI::App* add_export(CLI::App& app, ExportOptions& options) {
  CLI::App* command = app.add_subcommand(
      "export",
      "a record as a table (CSV) or, with --mcap, as a file for viewers; or a scene as MuJoCo has it");
  command->add_option("record", options.record, "file written by run --record, or a scene")->required();
  command->add_option("xml", options.xml, "of a scene: file to write, MJCF, which MuJoCo's simulate opens")
      ->check(unnamed);
  command->add_option("--csv", options.csv, "of a record: file to write; default: -, standard output")
      ->check(unnamed);
  command->add_option("--mcap", options.mcap, "of a record: MCAP file to write, for Foxglove")
      ->check(unnamed);
  command->add_option("--rig", options.rig, "of a scene: rig, as for run")->check(unnamed);
  command->add_option("--set", options.set, "of a scene: override, as for run");
  command->add_flag("--partial", options.partial, "of a record: export what a cut-off one still holds");
  command->add_flag("--ledger", options.ledger,
                    "of a record: the energy of each contact instead of its ticks");
  force_option(command, options.force);
  return command;
}

CLI::App* add_params(CLI::App& app, ParamsOptions& options) {
  CLI::App* command =
      app.add_subcommand("params", "every name that --set takes: unit, value, source, confidence (CSV)");
  scene_options(command, options);
  command->add_flag("--json", options.json, "JSON instead of CSV");
  return command;
}

CLI::App* add_bench(CLI::App& app, BenchOptions& options) {
  CLI::App* command = app.add_subcommand("bench", "run benchmarks; exit 1 where a figure is out of bounds");
  command->add_option("names", options.names,
                      "benchmarks, groups, or figures such as press.restore; none: all benchmarks");
  command
      ->add_option("--out", options.out,
                   "folder for report.html, REPORT.md, results.json, pictures and tables")
      ->check(unnamed);
  command->add_option("--seed", options.seed, "first seed")->capture_default_str()->check(bad_seed);
  command->add_option("--repeats", options.repeats, "seeds per row; default: the benchmark's own")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--set", options.set, "override, as for run");
  command->add_flag("--quick", options.quick, "fewer repeats; all of them in about a minute");
  command->add_flag("--full", options.full,
                    "also what takes minutes: what each part does, error against run time");
  command
      ->add_option("--rig", options.rig,
                   "measure over the devices of this rig in place of the twin: a name in models/rigs, or a "
                   "file; tracking and stiffness can")
      ->check(unnamed);
  device_options(command, options);
  command->add_flag("--fakes", options.fakes,
                    "`encounter fake` stands in for the devices of --rig; it is begun and ended here");
  command->add_flag("--list", options.list, "only print the benchmarks and what they show");
  force_option(command, options.force);
  return command;
}

CLI::App* add_fit(CLI::App& app, FitOptions& options) {
  CLI::App* command = app.add_subcommand(
      "fit", "turn a measured loop (CSV) into a response file, or into the ball behind it");
  command->add_option("loop", options.loops, "CSV with time_s, deflection_mm, force_N, repeat")->required();
  command->add_option("--out", options.out, "response file to write, models/responses/NAME.toml")
      ->check(unnamed);
  command->add_option("--limit-mm", options.limit_mm, "deflection up to which the response holds")
      ->capture_default_str();
  command->add_option("--rig", options.rig, "rig that will render it: sets how soft it may be")
      ->capture_default_str();
  command->add_option(
      "--ceiling-N-per-mm", options.ceiling,
      "stiffest that the stops may be; lower: quieter at rest, less exact where motion turns");
  command->add_flag("--ball", options.ball,
                    "the numbers of the ball that was pressed, with intervals; takes several loops");
  command->add_option("--hold", options.hold, "of the ball: NAME or NAME=VALUE that is known");
  command->add_option("--free", options.free, "of the ball: NAME to be found that is held otherwise");
  command->add_flag("--json", options.json, "of the ball: one JSON object instead of text");
  force_option(command, options.force);
  return command;
}

CLI::App* add_nearest(CLI::App& app, NearestOptions& options) {
  CLI::App* command = app.add_subcommand(
      "nearest",
      "signed distance, nearest surface point and normal for each point of a CSV file (x_m,y_m,z_m)");
  command->add_option("surface", options.what, "mesh file, points in its axes; or SCENE#object, points in W")
      ->required();
  command->add_option("points", options.points, "CSV file with the header x_m,y_m,z_m")->required();
  return command;
}

CLI::App* add_mesh(CLI::App& app, MeshOptions& options) {
  CLI::App* command = app.add_subcommand("mesh", "write a mesh of our own (.glb, .obj or .stl)");
  command->add_option("name", options.name, "ball, cube, hare, knot or turned_part")->required();
  command->add_option("--out", options.out, "file")->required()->check(unnamed);
  command->add_option("--fine", options.fine, "3 to 400: how finely it is cut; a ball has 20 n^2 triangles");
  force_option(command, options.force);
  return command;
}

CLI::App* add_questionnaire(CLI::App& app, QuestionnaireOptions& options) {
  CLI::App* command = app.add_subcommand(
      "questionnaire", "ask a person what the paper asked, keep the answers, show mean, range and counts");
  command->add_option("form", options.form, "a name in models/questionnaires, or a file")
      ->capture_default_str();
  command->add_option("--store", options.store, "CSV file that the answers are added to; what is in it stays")
      ->check(unnamed);
  command->add_option("--answers", options.answers, "CSV file with answers of many, in place of asking")
      ->check(unnamed);
  command->add_option("--participant", options.participant, "number or code; default: the next number");
  command->add_option("--out", options.out, "folder for picture and tables")->check(unnamed);
  command
      ->add_option("--results", options.results,
                   "results.json of a bench run: shows its figures beside the items")
      ->check(unnamed);
  command->add_flag("--date", options.date, "keep the date, too");
  json_option(command, options.json);
  force_option(command, options.force);
  return command;
}

// Adds a subcommand with its options, which live as long as the command line.
template <class Options>
void add(CLI::App& app, CLI::App* (*adds)(CLI::App&, Options&), int (*does)(const Options&), int& code) {
  const auto options = std::make_shared<Options>();
  adds(app, *options)->callback([options, does, &code] { code = does(*options); });
}

// Gives a better message than CLI11, which only says that a subcommand is missing.
void check_subcommand(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (argc > 1 && argv[1][0] != '-' && std::find(names.begin(), names.end(), argv[1]) == names.end())
    throw enc::Error("unknown subcommand '" + std::string(argv[1]) + "'; " +
                     enc::models::advice(argv[1], names));
}

int dispatch(CLI::App& app, int argc, char** argv) {
  int code = 0;
  add(app, add_run, run, code);
  add(app, add_check, check, code);
  add(app, add_fake, fake, code);
  add(app, add_devices, devices, code);
  add(app, add_replay, replay, code);
  add(app, add_export, export_record, code);
  add(app, add_view, view, code);
  add(app, add_tour, tour, code);
  add(app, add_params, params, code);
  add(app, add_bench, bench, code);
  add(app, add_fit, fit, code);
  CalibrateWords calibrate_words;
  add_calibrate(app, calibrate_words, code);
  add(app, add_shadow, shadow, code);
  add(app, add_nearest, nearest, code);
  add(app, add_mesh, mesh, code);
  add(app, add_questionnaire, questionnaire, code);
  CLI::App* scenes_command = app.add_subcommand("scenes", "the shipped scenes, a line each");
  scenes_command->callback([&] { code = scenes(); });
  CLI::App* doctor_command = app.add_subcommand("doctor", "is this machine ready? what to do if not");
  doctor_command->callback([&] { code = doctor(); });
  check_subcommand(app, argc, argv);
  if (argc > 1 && std::string_view(argv[1]) == "calibrate") check_subject({argv + 2, argv + argc});
  app.parse(argc, argv);
  return code;
}

// After a signal the reader of the output may be gone too, so do not check the output.
int whole(int code) {
  if (code <= 128) check_output();
  return code;
}

// CLI11 reports help and version as errors; they are not errors here.
int answered(CLI::App& app, int argc, char** argv) {
  try {
    return dispatch(app, argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) != 0 ? 2 : 0;
  }
}

}  // namespace

int command_line(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding a file size limit is that file's error, not the end
  CLI::App app("Encounter: a digital twin of encounter-type haptic displays", "encounter");
  app.set_version_flag("--version", trial::program_words());
  app.require_subcommand(1);
  app.failure_message([](const CLI::App* failed, const CLI::Error& e) {
    std::string command = "encounter";
    for (const CLI::App* at = failed; !at->get_subcommands().empty();) {
      at = at->get_subcommands().front();
      command += " " + at->get_name();
    }
    return "encounter: " + enc::models::printable(e.what()) + "; see " + command + " --help\n";
  });
  try {
    return whole(answered(app, argc, argv));
  } catch (const enc::Error& e) {
    std::fprintf(stderr, "encounter: %s\n", enc::models::printable(e.what()).c_str());
    return static_cast<int>(e.kind());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "encounter: there is not enough memory for this; give it less to do\n");
    return 2;
  } catch (const std::exception& e) {
    const bool output = std::ferror(stdout) != 0;  // fmt throws if it cannot print
    std::fprintf(stderr, "encounter: %s%s\n", output ? "standard output: " : "",
                 enc::models::printable(e.what()).c_str());
    return 2;
  }
}

}  // namespace enc::app
