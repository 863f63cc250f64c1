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
#include "app/command_line/help.h"
#include "app/common/command_options.h"
#include "app/common/options.h"
#include "app/laboratory/fakes.h"
#include "app/process.h"
#include "app/serve/serve.h"
#include "app/sweep/sweep_options.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "models/schema/wording.h"
#include "trial/provenance/provenance.h"

namespace enc::app {
namespace {

// Options of a view that draws into a file.
void drawing_options(CLI::App* command, ViewOptions& options, CLI::Option* record) {
  CLI::Option* shot =
      command->add_option("--shot", options.shot, "write a picture to this PNG file and open no window")
          ->check(bad_output)
          ->excludes(record);
  CLI::Option* video =
      command
          ->add_option("--video", options.video,
                       "write a film to this file and open no window: .mp4, .webm, .gif, .mkv or .mov with "
                       "ffmpeg; without an ending, or without ffmpeg, a folder of PNGs")
          ->check(bad_output)
          ->excludes(record)
          ->excludes(shot);
  command
      ->add_option(
          "--for-s", options.seconds,
          "length of the film, s of simulated time; default: until the simulated user or the probe is done")
      ->needs(video);
  command->add_option("--at-s", options.at,
                      "time of the picture, s from the start of the scene (default: the deepest point of the "
                      "first press, or 4 s through the camera); or start of the film (default: 0)");
  CLI::Option* close_up =
      command->add_flag("--close-up", options.close_up, "show the contact instead of the whole machine");
  command
      ->add_option("--through-camera", options.through_camera,
                   "draw the view of the scene's left camera: raw; removed (without the arm); or augmented "
                   "(virtual objects in place of the arm)")
      ->check(CLI::IsMember({"raw", "removed", "augmented"}))
      ->excludes(close_up);
}

CLI::App* add_view(CLI::App& app, ViewOptions& options) {
  CLI::App* command = add_command(
      app, "view", "Run a scene in a window, where the mouse is the hand, or draw it into a file.",
      "view tennis_ball");
  scene_options(command, options);
  command->get_option("scene")->required(false)->description(
      "scene file, name of a shipped scene, or record; without one you choose in the window");
  CLI::Option* record =
      command
          ->add_option("--record", options.record,
                       "write inputs and outputs of every tick, and the hand, to this file (window only)")
          ->check(bad_output);
  drawing_options(command, options, record);
  device_options(command, options);
  force_option(command, options.force);
  return command;
}

CLI::App* add_tour(CLI::App& app, TourOptions& options) {
  CLI::App* command =
      add_command(app, "tour", "Make a film of each shipped scene, from a second before its first touch.",
                  "tour --out films");
  command->add_option("--out", options.out, "folder for the films")->check(bad_output)->capture_default_str();
  command->add_option("--for-s", options.seconds, "length of each film, s of experiment")
      ->capture_default_str();
  force_option(command, options.force);
  return command;
}

CLI::App* add_shadow(CLI::App& app, ShadowOptions& options) {
  CLI::App* command = add_command(
      app, "shadow", "Compare a record with the twin, channel by channel; exit code 1 if one diverges.",
      "shadow press.encrec");
  command->add_option("record", options.record, "file written by run --record")->required();
  command->add_option("--set", options.set,
                      "override the record's own set-up, for example truth.tracker.latency_ms=3.5");
  command->add_flag("--partial", options.partial, "read the complete part of a cut-off record");
  json_option(command, options.json);
  return command;
}

CLI::App* add_run(CLI::App& app, RunOptions& options) {
  CLI::App* command = add_command(app, "run", "Run a scene and report what happened.",
                                  "run tennis_ball --record press.encrec");
  scene_options(command, options);
  command
      ->add_option("--pace", options.pace,
                   "free (as fast as possible), wall (real time), or a factor on real time")
      ->capture_default_str();
  command->add_option("--for-s", options.seconds,
                      "length of the run, s; default: until the simulated user or the probe is done, or 10 s "
                      "if all devices are real");
  command->add_option("--record", options.record, "write inputs and outputs of every tick to this file")
      ->check(bad_output);
  command
      ->add_option("--mcap", options.mcap,
                   "write the run to this MCAP file, for Foxglove (not with real devices)")
      ->check(bad_output);
  command
      ->add_option("--live", options.live,
                   "let viewers such as Foxglove watch the run at this port, or ADDRESS:PORT for other "
                   "computers, such as 0.0.0.0:8765; the pace is then wall")
      ->check(unnamed);
  command
      ->add_option("--frames", options.frames,
                   "write the images of the scene's camera to this new folder (PNG)")
      ->check(bad_output);
  command
      ->add_option("--hand", options.hand, "repeat the hand's motion from this record of `view`, to its end")
      ->check(unnamed);
  json_option(command, options.json);
  device_options(command, options);
  force_option(command, options.force);
  return command;
}

CLI::App* add_serve(CLI::App& app, ServeOptions& options) {
  CLI::App* command = add_command(
      app, "serve",
      "Run a scene in step with your program: rows on standard output, places of the tool's tip on standard "
      "input.",
      "serve tennis_ball --every-ms 10");
  scene_options(command, options);
  command->add_option_function<double>(
      "--every-ms", [&options](double ms) { options.every = ms * kMillisecond; },
      "time between two rows, ms; 0: each tick");
  command->add_option("--for-s", options.seconds, "length of the run, s; default: until standard input ends");
  command
      ->add_option("--record", options.record,
                   "write inputs and outputs of every tick, and the hand, to this file")
      ->check(bad_output);
  force_option(command, options.force);
  return command;
}

CLI::App* add_sweep(CLI::App& app, SweepOptions& options) {
  CLI::App* command =
      add_command(app, "sweep", "Run a scene many times with varied parameters; started again, it goes on.",
                  "sweep reach.toml --out reach");
  command
      ->add_option("spec", options.spec,
                   "file with scene, parameters, seeds and measures (docs/guide/sweep.md)")
      ->required();
  command->add_option("--out", options.out, "folder for the results; default: the spec's name with _sweep")
      ->check(bad_output);
  CLI::Option* shard = command->add_option(
      "--shard", options.shard,
      "do a part: I/N, such as 0/7 to 6/7; auto or auto/N: as Slurm array, MPI launcher, HTCondor or GNU "
      "parallel number this process");
  command->add_option("--submit", options.submit, "print the batch script for --shard auto/N")
      ->check(CLI::IsMember({"slurm"}));
  CLI::Option* merge =
      command->add_flag("--merge", options.merge, "write the results of all shards")->excludes(shard);
  CLI::Option* status = command->add_flag("--status", options.status, "print what each shard has done")
                            ->excludes(shard)
                            ->excludes(merge);
  command->add_option("--only", options.only, "failed: run the failed runs again, too")
      ->check(CLI::IsMember({"failed"}))
      ->excludes(merge)
      ->excludes(status);
  return command;
}

CLI::App* add_check(CLI::App& app, CheckOptions& options) {
  CLI::App* command = add_command(
      app, "check",
      "Check a scene and its rig without moving anything: mistakes, parts, frames, stability, cost.",
      "check tennis_ball --rig laboratory");
  scene_options(command, options);
  CLI::Option* resolved = command->add_flag(
      "--resolved", options.resolved,
      "print one scene file that needs no other file, with only the parts that the scene uses");
  CLI::Option* advise =
      command->add_flag("--advise", options.advise,
                        "also run the twin with several time steps and integrators (about "
                        "a minute) and name the cheapest within --error-N, --error-um or both");
  advise->excludes(resolved);
  command
      ->add_option("--error-N", options.error_N,
                   "for --advise: largest error of the true force, N rms during contact")
      ->needs(advise);
  command->add_option("--error-um", options.error_um, "for --advise: largest error of the tip's path, um rms")
      ->needs(advise);
  return command;
}

CLI::App* add_fake(CLI::App& app, LaboratoryOptions& options) {
  CLI::App* command =
      add_command(app, "fake", "Answer for the devices of a rig on their real protocols.", "fake fakes");
  command->add_option("rig", options.rig, "a name in models/rigs, or a file")->required();
  command
      ->add_option("--scene", options.scene,
                   "scene of the simulated world; default: the tennis ball, for an arm the wall")
      ->check(unnamed);
  command->add_option("--set", options.set, "override, as for run");
  command->add_option("--seed", options.seed, "seed of all noise; default: 1")->check(bad_seed);
  command->add_flag("--lockstep", options.lockstep,
                    "advance time by one period with each set-point (run --lockstep)");
  command->add_option("--fault", options.faults,
                      "DRIVER:FAULT[=V][@TIME][+TIME], such as gcs:stall@3s+500ms: which fault, how long "
                      "after a client connects, and for how long; repeatable. Faults: " +
                          fault_examples() +
                          ". A line of standard input injects one at once; 'heal' ends the active ones");
  return command;
}

CLI::App* add_devices(CLI::App& app, LaboratoryOptions& options) {
  CLI::App* command = add_command(
      app, "devices", "Measure how often and how late the devices of a rig send data; nothing moves.",
      "devices fakes");
  command->add_option("rig", options.rig, "a name in models/rigs, or a file")->required();
  command
      ->add_option("--scene", options.scene,
                   "scene whose devices are read; default: the tennis ball, for an arm the wall")
      ->check(unnamed);
  command->add_option("--set", options.set, "override, as for run");
  command->add_option("--for-s", options.seconds, "time for which each device is read, s")
      ->capture_default_str();
  return command;
}

CLI::App* add_replay(CLI::App& app, ReplayOptions& options) {
  CLI::App* command =
      add_command(app, "replay", "Run the core again over a record; exit code 1 if any output differs.",
                  "replay press.encrec");
  command->add_option("record", options.record, "file written by run --record")->required();
  command
      ->add_option("--frames", options.frames,
                   "folder of run --frames: run vision again, too; exit code 1 if it differs")
      ->check(unnamed);
  command->add_flag("--partial", options.partial, "replay the complete part of a cut-off record");
  return command;
}

CLI::App* add_export(CLI::App& app, ExportOptions& options) {
  CLI::App* command =
      add_command(app, "export", "Write a record as a table or for a viewer, or a scene for MuJoCo.",
                  "export press.encrec --csv press.csv");
  command->add_option("record", options.record, "file written by run --record, or a scene")->required();
  command->add_option("xml", options.xml, "MJCF file to write (scene only); MuJoCo's simulate opens it")
      ->check(unnamed);
  command->add_option("--csv", options.csv, "CSV file to write (record only); default: -, standard output")
      ->check(unnamed);
  CLI::Option* mcap =
      command->add_option("--mcap", options.mcap, "MCAP file to write, for Foxglove (record only)")
          ->check(bad_output);
  command
      ->add_flag("--ros2", options.ros2, "messages of ROS 2, for ros2 bag and PlotJuggler, instead of JSON")
      ->needs(mcap);
  command->add_flag("--uncompressed", options.uncompressed, "no zstd, for readers without it")->needs(mcap);
  command->add_option("--rig", options.rig, "rig, as for run (scene only)")->check(unnamed);
  command->add_option("--set", options.set, "override, as for run (scene only)");
  command->add_flag("--partial", options.partial, "export the complete part of a cut-off record");
  command->add_flag("--ledger", options.ledger,
                    "write the energy balance of each contact instead of the ticks");
  command->add_flag("--truth", options.truth,
                    "table only: run the twin again and add columns with its ground truth");
  force_option(command, options.force);
  return command;
}

CLI::App* add_plot(CLI::App& app, PlotOptions& options) {
  CLI::App* command = add_command(
      app, "plot", "Draw force, deflection, gap and modes of a record, and force over deflection (SVG).",
      "plot press.encrec press.svg");
  command->add_option("record", options.record, "file written by run --record")->required();
  command->add_option("svg", options.svg, "SVG file to write; -: standard output")
      ->required()
      ->check(unnamed);
  command->add_flag("--partial", options.partial, "draw the complete part of a cut-off record");
  force_option(command, options.force);
  return command;
}

CLI::App* add_params(CLI::App& app, ParamsOptions& options) {
  CLI::App* command =
      add_command(app, "params", "List every name that --set takes: unit, value, source, confidence (CSV).",
                  "params tennis_ball");
  scene_options(command, options);
  command->add_flag("--json", options.json, "JSON instead of CSV");
  return command;
}

CLI::App* add_bench(CLI::App& app, BenchOptions& options) {
  CLI::App* command = add_command(app, "bench", "Run benchmarks; exit code 1 if a figure is out of bounds.",
                                  "bench paper-2020 --out out");
  command->add_option("names", options.names,
                      "benchmarks, groups, or figures such as press.restore; none: all benchmarks");
  command
      ->add_option("--out", options.out,
                   "folder for report.html, REPORT.md, results.json, pictures and tables")
      ->check(bad_output);
  command->add_option("--seed", options.seed, "first seed")->capture_default_str()->check(bad_seed);
  command->add_option("--repeats", options.repeats, "seeds per row; default: the benchmark's own")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--set", options.set, "override, as for run");
  command->add_flag("--quick", options.quick, "fewer repeats; all benchmarks take some minutes");
  command->add_flag("--full", options.full,
                    "also the slow tables: effect of switching each part off, error against run time");
  command
      ->add_option("--rig", options.rig,
                   "measure on the devices of this rig instead of the twin (a name in models/rigs, or a "
                   "file); only for tracking and stiffness")
      ->check(unnamed);
  device_options(command, options);
  command->add_flag("--fakes", options.fakes, "start and stop `encounter fake` for the devices of --rig");
  command->add_flag("--list", options.list, "only list the benchmarks");
  command->add_flag("--mutate", options.mutate,
                    "test the bounds: run each benchmark clean and with each of its mutants, such as `bench "
                    "--mutate deformation`; exit code 1 if a bound stays green under all of them");
  command->add_flag("--json", options.json, "with --mutate: one JSON object instead of text");
  force_option(command, options.force);
  return command;
}

CLI::App* add_fit(CLI::App& app, FitOptions& options) {
  CLI::App* command =
      add_command(app, "fit", "Fit a response file, or the parameters of a ball, to measured presses (CSV).",
                  "fit loop.csv --out models/responses/foam.toml");
  command->add_option("loop", options.loops, "CSV with time_s, deflection_mm, force_N, repeat")->required();
  command->add_option("--out", options.out, "response file to write, models/responses/NAME.toml")
      ->check(bad_output);
  command->add_option("--limit-mm", options.limit_mm, "deflection up to which the response is valid")
      ->capture_default_str();
  command->add_option("--rig", options.rig, "rig that will render the response; sets the minimum stiffness")
      ->capture_default_str();
  command->add_option("--ceiling-N-per-mm", options.ceiling,
                      "largest stiffness of the stops; a lower one reduces the force of a tremor at rest, "
                      "and the accuracy where the motion reverses");
  command->add_flag(
      "--ball", options.ball,
      "find the parameters of the pressed ball, with confidence intervals, from one or more files");
  command->add_option("--hold", options.hold, "with --ball: keep parameter NAME fixed, or NAME=VALUE");
  command->add_option("--free", options.free, "with --ball: fit parameter NAME, which is fixed by default");
  command->add_flag("--json", options.json, "with --ball: one JSON object instead of text");
  force_option(command, options.force);
  return command;
}

CLI::App* add_nearest(CLI::App& app, NearestOptions& options) {
  CLI::App* command = add_command(
      app, "nearest", "Print signed distance, nearest surface point and normal of each point of a CSV file.",
      "nearest models/meshes/hare.glb points.csv");
  command
      ->add_option("surface", options.what,
                   "mesh file, with points in its axes; or SCENE#object, with points in W")
      ->required();
  command->add_option("points", options.points, "CSV file with the header x_m,y_m,z_m")->required();
  return command;
}

CLI::App* add_mesh(CLI::App& app, MeshOptions& options) {
  CLI::App* command = add_command(app, "mesh", "Write a closed example mesh (.glb, .obj or .stl).",
                                  "mesh ball --fine 71 --out ball.glb");
  command->add_option("name", options.name, "ball, cube, hare, knot or turned_part")->required();
  command->add_option("--out", options.out, "file to write")->required()->check(bad_output);
  command->add_option("--fine", options.fine, "fineness n, 3 to 400; a ball has 20 n^2 triangles");
  force_option(command, options.force);
  return command;
}

CLI::App* add_questionnaire(CLI::App& app, QuestionnaireOptions& options) {
  CLI::App* command =
      add_command(app, "questionnaire",
                  "Ask a person the paper's questions, keep the answers, show mean, range and counts.",
                  "questionnaire vhmr_2020 --store answers.csv");
  command->add_option("form", options.form, "a name in models/questionnaires, or a file")
      ->capture_default_str();
  command->add_option("--store", options.store, "CSV file to which the answers are appended")
      ->check(bad_output);
  command->add_option("--answers", options.answers, "CSV file with answers of many people, instead of asking")
      ->check(unnamed);
  command->add_option("--participant", options.participant, "number or code; default: the next number");
  command->add_option("--out", options.out, "folder for picture and tables")->check(bad_output);
  command
      ->add_option("--results", options.results,
                   "results.json of a bench run: shows its figures beside the items")
      ->check(unnamed);
  command->add_flag("--date", options.date, "store the date, too");
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
  add(app, add_plot, plot, code);
  add(app, add_view, view, code);
  add(app, add_tour, tour, code);
  add(app, add_params, params, code);
  add(app, add_serve, serve, code);
  add(app, add_sweep, sweep, code);
  add(app, add_bench, bench, code);
  add(app, add_fit, fit, code);
  CalibrateWords calibrate_words;
  add_calibrate(app, calibrate_words, code);
  add(app, add_shadow, shadow, code);
  add(app, add_nearest, nearest, code);
  add(app, add_mesh, mesh, code);
  add(app, add_questionnaire, questionnaire, code);
  CLI::App* scenes_command = add_command(app, "scenes", "List the shipped scenes.", "scenes");
  scenes_command->callback([&] { code = scenes(); });
  CLI::App* doctor_command =
      add_command(app, "doctor", "Report whether this computer is ready, and what to do if not.", "doctor");
  doctor_command->callback([&] { code = doctor(); });
  add_help(app);
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
  app.formatter(std::make_shared<Help>());
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
