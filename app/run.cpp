#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include <encounter_version.h>
#include <fmt/format.h>
#include <unistd.h>

#include "app/built.h"
#include "app/options.h"
#include "app/process.h"
#include "app/run_report.h"
#include "benchmarks/press_measure.h"
#include "benchmarks/probe_measure.h"
#include "benchmarks/trial.h"
#include "core/error.h"

namespace enc::app {
namespace {

double pace_of(const std::string& text) {
  if (text == "free") return 0.0;
  if (text == "wall") return 1.0;
  double factor = 0.0;
  const auto [end, bad] = std::from_chars(text.data(), text.data() + text.size(), factor);
  if (bad != std::errc() || end != text.data() + text.size() || !(factor > 0.0) || !std::isfinite(factor))
    throw Error("--pace '" + text + "': expected free, wall, or a positive number such as 0.1 or 10");
  return factor;
}

// Of the devices that the scene names.
bool all_simulated(const models::Setup& setup) {
  const SceneSpec& scene = setup.scene;
  const RigSpec& rig = setup.rig;
  const auto simulated = [](bool named, const std::string& driver) { return !named || driver == "sim"; };
  return simulated(scene.manipulator.has_value(), rig.manipulator.driver) &&
         simulated(scene.arm.has_value(), rig.arm.driver) &&
         simulated(scene.force.has_value(), rig.force.driver) &&
         simulated(scene.tracker.has_value(), rig.tracker.driver) &&
         simulated(scene.display.has_value(), rig.display.driver) &&
         simulated(scene.gripper.has_value(), rig.gripper.driver);
}

void show_progress(double share) {
  const int percent = static_cast<int>(std::lround(share * 100.0));
  fmt::print(stderr, "\r  {:3d} %", percent);
  std::fflush(stderr);
}

std::unique_ptr<RecordWriter> record_for(const RunOptions& options, const models::Setup& setup) {
  if (options.record.empty()) return nullptr;
  RecordTexts texts = models::record_texts(setup);
  texts["scene"] = options.scene;
  texts["rig"] = setup.rig_path;
  texts["seed"] = std::to_string(options.seed);
  texts["version"] = ENCOUNTER_VERSION;
  return std::make_unique<RecordWriter>(options.record, texts);
}

}  // namespace

int run(const RunOptions& options) {
  const models::Setup setup = models::load(options.scene, options.rig, options.set);
  if (options.seconds && !(*options.seconds > 0.0 && *options.seconds < 1e6))
    throw Error("--for-s: expected a positive number of seconds below a million");
  bench::PressMeasure presses(setup);
  bench::ProbeMeasure pushes;
  bench::FingerMeasure fingers;
  bench::TrialOptions trial_options;
  trial_options.seed = options.seed;
  trial_options.seconds = options.seconds.value_or(kUnset);
  trial_options.pace = pace_of(options.pace);
  // Real devices live in wall time (decisions 9), and the simulated ones then follow.
  if (!all_simulated(setup) && trial_options.pace != 1.0) {
    if (options.pace != "free") throw Error("--pace: a rig with real devices runs at wall pace only");
    trial_options.pace = 1.0;
  }
  trial_options.fit_out = [&](Rig& rig) { fit_out(rig, setup, options.armed); };
  trial_options.watch = [&](const bench::Glance& glance) {
    presses.see(glance);
    pushes.see(glance);
    fingers.see(glance);
  };
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal) trial_options.progress = show_progress;
  bench::Trial trial(
      setup, trial_options);  // everything that can be refused is refused here, before a record is begun
  const std::unique_ptr<RecordWriter> record = record_for(options, setup);
  print_notes(setup.notes);  // of a scene that is not refused
  trial.record_to(record.get());
  const double started = cpu_seconds();
  const bench::TrialResult result = trial.run();
  if (record) record->close();
  if (terminal) fmt::print(stderr, "\r        \r");

  const RunReport report{setup, trial.scene(), result, presses, pushes, fingers, started};
  fmt::print("{}", options.json ? run_json(report) : run_text(report));
  if (record && record->full()) throw Error(record->error());
  if (result.diverged_at >= 0)
    throw Error(
        fmt::format("the physics diverged at tick {}: {}; try a smaller {}.timestep_us", result.diverged_at,
                    result.divergence, setup.twin.stepping(setup.scene.arm.has_value()).table),
        {}, ErrorKind::device);
  return result.last_mode == Mode::hold ? 4 : 0;
}

}  // namespace enc::app
