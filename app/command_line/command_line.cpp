// The command line. Each subcommand is one function in a file of its own (options.h). Exit codes: 0 yes, 1
// the answer is no, 2 the words or files are wrong, 3 a device, 4 ended in hold or diverged; 129, 130, 131
// and 143 after a clean end by SIGHUP, SIGINT, SIGQUIT and SIGTERM.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/calibrate/calibrate.h"
#include "app/command_line/parts.h"
#include "app/common/command_options.h"
#include "app/common/options.h"
#include "app/laboratory/fault_text.h"
#include "app/laboratory/laboratory.h"
#include "app/process.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "trial/provenance/provenance.h"

namespace enc::app {
namespace {

int dispatch(CLI::App& app, int argc, char** argv) {
  int code = 0;
  RunOptions run_options;
  CLI::App* run_command = app.add_subcommand("run", "run a scene and say what happened");
  scene_options(run_command, run_options);
  run_command
      ->add_option("--pace", run_options.pace, "free, wall, or seconds of experiment per second of wall time")
      ->capture_default_str();
  run_command->add_option("--for-s", run_options.seconds,
                          "length, s of experiment; default: until the user or the probe is done");
  run_command
      ->add_option("--record", run_options.record, "write inputs and outputs of every tick to this file")
      ->check(unnamed);
  run_command
      ->add_option("--frames", run_options.frames,
                   "keep what the scene's camera sees in this new folder, as PNG images")
      ->check(unnamed);
  run_command
      ->add_option("--hand", run_options.hand,
                   "record of a view: the hand that was steered there moves, for as long as it did")
      ->check(unnamed);
  run_command->add_flag("--json", run_options.json, "one JSON object instead of text");
  device_options(run_command, run_options);
  force_option(run_command, run_options.force);
  run_command->callback([&] { code = run(run_options); });

  CheckOptions check_options;
  CLI::App* check_command = app.add_subcommand(
      "check",
      "read a scene and its rig, find their mistakes, and say what will be built, what is left out and why, "
      "where each frame is, how hard and how soft an object may be, what it costs; no device moves (the twin "
      "runs for 0.25 s)");
  scene_options(check_command, check_options);
  CLI::Option* resolved =
      check_command->add_flag("--resolved", check_options.resolved,
                              "print the scene with only what it builds, as a scene file that runs");
  CLI::Option* advise = check_command->add_flag(
      "--advise", check_options.advise,
      "also run it at several time steps and integrators of its twin (about a minute) and name the "
      "cheapest that errs by no more than --error-N, --error-um");
  advise->excludes(resolved);
  check_command
      ->add_option("--error-N", check_options.error_N,
                   "of --advise: error of the true force, N rms while something touches")
      ->needs(advise);
  check_command
      ->add_option("--error-um", check_options.error_um, "of --advise: error of the tip's path, um rms")
      ->needs(advise);
  check_command->callback([&] { code = check(check_options); });

  LaboratoryOptions fake_options;
  CLI::App* fake_command = app.add_subcommand(
      "fake",
      "stand in for the devices of a rig: serve their wires from one simulated world, until it is told "
      "to end");
  fake_command->add_option("rig", fake_options.rig, "a name in models/rigs, or a file")->required();
  fake_command->add_option("--scene", fake_options.scene, "what happens there; default: the tennis ball")
      ->check(unnamed);
  fake_command->add_option("--set", fake_options.set, "override, as for run");
  fake_command->add_option("--seed", fake_options.seed, "of all noise")->check(bad_seed);
  fake_command->add_flag("--lockstep", fake_options.lockstep,
                         "time goes on by a period with each set-point, and not by itself (run --lockstep)");
  fake_command->add_option(
      "--fault", fake_options.faults,
      "DRIVER:FAULT[=V][@TIME][+TIME], such as gcs:stall@3s+500ms: what goes wrong, when "
      "after somebody came, and for how long; again for more. Faults: " +
          fault_examples() + ". The same on a line of standard input: now; 'heal' ends all");
  fake_command->callback([&] { code = fake(fake_options); });

  LaboratoryOptions devices_options;
  CLI::App* devices_command = app.add_subcommand(
      "devices",
      "ask the devices of a rig: what answers, how often, how regularly and how late; nothing moves");
  devices_command->add_option("rig", devices_options.rig, "a name in models/rigs, or a file")->required();
  devices_command->add_option("--scene", devices_options.scene, "whose devices; default: the tennis ball's")
      ->check(unnamed);
  devices_command->add_option("--set", devices_options.set, "override, as for run");
  devices_command->add_option("--for-s", devices_options.seconds, "how long each is read")
      ->capture_default_str();
  devices_command->callback([&] { code = devices(devices_options); });

  ReplayOptions replay_options;
  CLI::App* replay_command =
      app.add_subcommand("replay", "run step() again over a record; exit 1 where outputs differ");
  replay_command->add_option("record", replay_options.record, "file written by run --record")->required();
  replay_command
      ->add_option("--frames", replay_options.frames,
                   "folder of run --frames: vision looks at it again; exit 1 where it tells something else")
      ->check(unnamed);
  replay_command->add_flag("--partial", replay_options.partial, "replay what a cut-off record still holds");
  replay_command->callback([&] { code = replay(replay_options); });

  ExportOptions export_options;
  CLI::App* export_command = app.add_subcommand(
      "export",
      "a record as a table (CSV) or, with --mcap, as a file for viewers; or a scene as MuJoCo has it");
  export_command->add_option("record", export_options.record, "file written by run --record, or a scene")
      ->required();
  export_command
      ->add_option("xml", export_options.xml,
                   "of a scene: file to write, MJCF, which MuJoCo's simulate opens")
      ->check(unnamed);
  export_command
      ->add_option("--csv", export_options.csv, "of a record: file to write; default: -, standard output")
      ->check(unnamed);
  export_command->add_option("--mcap", export_options.mcap, "of a record: MCAP file to write, for Foxglove")
      ->check(unnamed);
  export_command->add_option("--rig", export_options.rig, "of a scene: rig, as for run")->check(unnamed);
  export_command->add_option("--set", export_options.set, "of a scene: override, as for run");
  export_command->add_flag("--partial", export_options.partial,
                           "of a record: export what a cut-off one still holds");
  export_command->add_flag("--ledger", export_options.ledger,
                           "of a record: the energy of each contact instead of its ticks");
  force_option(export_command, export_options.force);
  export_command->callback([&] { code = export_record(export_options); });

  ViewOptions view_options;
  add_view(app, view_options)->callback([&] { code = view(view_options); });

  TourOptions tour_options;
  add_tour(app, tour_options)->callback([&] { code = tour(tour_options); });

  ParamsOptions params_options;
  CLI::App* params_command =
      app.add_subcommand("params", "every name that --set takes: unit, value, source, confidence (CSV)");
  scene_options(params_command, params_options);
  params_command->add_flag("--json", params_options.json, "JSON instead of CSV");
  params_command->callback([&] { code = params(params_options); });

  BenchOptions bench_options;
  CLI::App* bench_command =
      app.add_subcommand("bench", "run benchmarks; exit 1 where a figure is out of bounds");
  bench_command->add_option("names", bench_options.names,
                            "benchmarks, groups, or figures such as press.restore; none: all benchmarks");
  bench_command
      ->add_option("--out", bench_options.out,
                   "folder for report.html, REPORT.md, results.json, pictures and tables")
      ->check(unnamed);
  bench_command->add_option("--seed", bench_options.seed, "first seed")
      ->capture_default_str()
      ->check(bad_seed);
  bench_command->add_option("--repeats", bench_options.repeats, "seeds per row; default: the benchmark's own")
      ->check(CLI::Range(1, 1'000'000));
  bench_command->add_option("--set", bench_options.set, "override, as for run");
  bench_command->add_flag("--quick", bench_options.quick, "fewer repeats; all of them in about a minute");
  bench_command->add_flag("--full", bench_options.full,
                          "also what takes minutes: what each part does, error against run time");
  bench_command
      ->add_option("--rig", bench_options.rig,
                   "measure over the devices of this rig in place of the twin: a name in models/rigs, or a "
                   "file; tracking and stiffness can")
      ->check(unnamed);
  device_options(bench_command, bench_options);
  bench_command->add_flag("--fakes", bench_options.fakes,
                          "`encounter fake` stands in for the devices of --rig; it is begun and ended here");
  bench_command->add_flag("--list", bench_options.list, "only print the benchmarks and what they show");
  force_option(bench_command, bench_options.force);
  bench_command->callback([&] { code = bench(bench_options); });

  FitOptions fit_options;
  CLI::App* fit_command = app.add_subcommand(
      "fit", "turn a measured loop (CSV) into a response file, or into the ball behind it");
  fit_command->add_option("loop", fit_options.loops, "CSV with time_s, deflection_mm, force_N, repeat")
      ->required();
  fit_command->add_option("--out", fit_options.out, "response file to write, models/responses/NAME.toml")
      ->check(unnamed);
  fit_command->add_option("--limit-mm", fit_options.limit_mm, "deflection up to which the response holds")
      ->capture_default_str();
  fit_command->add_option("--rig", fit_options.rig, "rig that will render it: sets how soft it may be")
      ->capture_default_str();
  fit_command->add_option(
      "--ceiling-N-per-mm", fit_options.ceiling,
      "stiffest that the stops may be; lower: quieter at rest, less exact where motion turns");
  fit_command->add_flag("--ball", fit_options.ball,
                        "the numbers of the ball that was pressed, with intervals; takes several loops");
  fit_command->add_option("--hold", fit_options.hold, "of the ball: NAME or NAME=VALUE that is known");
  fit_command->add_option("--free", fit_options.free, "of the ball: NAME to be found that is held otherwise");
  fit_command->add_flag("--json", fit_options.json, "of the ball: one JSON object instead of text");
  force_option(fit_command, fit_options.force);
  fit_command->callback([&] { code = fit(fit_options); });

  CalibrateWords calibrate_words;
  add_calibrate(app, calibrate_words, code);

  ShadowOptions shadow_options;
  add_shadow(app, shadow_options)->callback([&] { code = shadow(shadow_options); });

  NearestOptions nearest_options;
  CLI::App* nearest_command = app.add_subcommand(
      "nearest",
      "signed distance, nearest surface point and normal for each point of a CSV file (x_m,y_m,z_m)");
  nearest_command
      ->add_option("surface", nearest_options.what,
                   "mesh file, points in its axes; or SCENE#object, points in W")
      ->required();
  nearest_command->add_option("points", nearest_options.points, "CSV file with the header x_m,y_m,z_m")
      ->required();
  nearest_command->callback([&] { code = nearest(nearest_options); });

  MeshOptions mesh_options;
  CLI::App* mesh_command = app.add_subcommand("mesh", "write a mesh of our own (.glb, .obj or .stl)");
  mesh_command->add_option("name", mesh_options.name, "ball, cube, hare, knot or turned_part")->required();
  mesh_command->add_option("--out", mesh_options.out, "file")->required()->check(unnamed);
  mesh_command->add_option("--fine", mesh_options.fine,
                           "3 to 400: how finely it is cut; a ball has 20 n^2 triangles");
  force_option(mesh_command, mesh_options.force);
  mesh_command->callback([&] { code = mesh(mesh_options); });

  QuestionnaireOptions questionnaire_options;
  CLI::App* questionnaire_command = app.add_subcommand(
      "questionnaire", "ask a person what the paper asked, keep the answers, show mean, range and counts");
  questionnaire_command
      ->add_option("form", questionnaire_options.form, "a name in models/questionnaires, or a file")
      ->capture_default_str();
  questionnaire_command
      ->add_option("--store", questionnaire_options.store,
                   "CSV file that the answers are added to; what is in it stays")
      ->check(unnamed);
  questionnaire_command
      ->add_option("--answers", questionnaire_options.answers,
                   "CSV file with answers of many, in place of asking")
      ->check(unnamed);
  questionnaire_command->add_option("--participant", questionnaire_options.participant,
                                    "number or code; default: the next number");
  questionnaire_command->add_option("--out", questionnaire_options.out, "folder for picture and tables")
      ->check(unnamed);
  questionnaire_command
      ->add_option("--results", questionnaire_options.results,
                   "results.json of a bench run: shows its figures beside the items")
      ->check(unnamed);
  questionnaire_command->add_flag("--date", questionnaire_options.date, "keep the date, too");
  questionnaire_command->add_flag("--json", questionnaire_options.json, "one JSON object instead of text");
  force_option(questionnaire_command, questionnaire_options.force);
  questionnaire_command->callback([&] { code = questionnaire(questionnaire_options); });

  CLI::App* scenes_command = app.add_subcommand("scenes", "the shipped scenes, a line each");
  scenes_command->callback([&] { code = scenes(); });

  CLI::App* doctor_command = app.add_subcommand("doctor", "is this machine ready? what to do if not");
  doctor_command->callback([&] { code = doctor(); });

  // CLI11 would only say that a subcommand is missing.
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (argc > 1 && argv[1][0] != '-' && std::find(names.begin(), names.end(), argv[1]) == names.end())
    throw enc::Error("unknown subcommand '" + std::string(argv[1]) + "'; " +
                     enc::models::advice(argv[1], names));
  if (argc > 1 && std::string_view(argv[1]) == "calibrate") check_subject({argv + 2, argv + argc});
  app.parse(argc, argv);
  return code;
}

// After a signal whoever reads may be gone: stopped by the same Ctrl-C, or hung up.
int whole(int code) {
  if (code <= 128) check_output();
  return code;
}

// Help and version are no errors, but are printed by them.
int answered(CLI::App& app, int argc, char** argv) {
  try {
    return dispatch(app, argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) != 0 ? 2 : 0;
  }
}

}  // namespace

int command_line(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is an error of that file, not the end of the run
  CLI::App app("Encounter: a digital twin of encounter-type haptic displays", "encounter");
  app.set_version_flag("--version", trial::program_words());
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& e) {
    return "encounter: " + enc::models::printable(e.what()) + "; see encounter --help\n";
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
    const bool output = std::ferror(stdout) != 0;  // fmt throws what it cannot print
    std::fprintf(stderr, "encounter: %s%s\n", output ? "standard output: " : "",
                 enc::models::printable(e.what()).c_str());
    return 2;
  }
}

}  // namespace enc::app
