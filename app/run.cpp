#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>

#include <encounter_version.h>
#include <fmt/format.h>
#include <unistd.h>

#include "app/built.h"
#include "app/modules.h"
#include "app/options.h"
#include "app/process.h"
#include "app/run_report.h"
#include "app/stop_signals.h"
#include "core/error.h"
#include "trial/measure/press_measure.h"
#include "trial/measure/probe_measure.h"
#include "trial/trial.h"

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

// Whoever reads may be gone: stopped by the same Ctrl-C, or hung up.
bool printed(const std::string& text) {
  const std::size_t all = std::fwrite(text.data(), 1, text.size(), stdout);
  return all == text.size() && std::fflush(stdout) == 0;
}

}  // namespace

int run(const RunOptions& options) {
  const StopSignals signals;  // from here on: devices are let go, whenever it comes
  const models::Setup setup = models::load(options.scene, options.rig, options.set);
  if (options.seconds && !(*options.seconds > 0.0 && *options.seconds < 1e6))
    throw Error("--for-s: expected a positive number of seconds below a million");
  trial::PressMeasure presses(setup);
  trial::ProbeMeasure pushes;
  trial::FingerMeasure fingers;
  trial::TrialOptions trial_options;
  trial_options.seed = options.seed;
  trial_options.seconds = options.seconds.value_or(kUnset);
  trial_options.pace = pace_of(options.pace);
  trial_options.drivers = load_module;
  trial_options.armed = options.armed;
  trial_options.watch = [&](const trial::Glance& glance) {
    presses.see(glance);
    pushes.see(glance);
    fingers.see(glance);
  };
  trial_options.stop = [] { return StopSignals::caught() != 0; };
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal) trial_options.progress = show_progress;
  trial::Trial trial(
      setup, trial_options);  // everything that can be refused is refused here, before a record is begun
  const std::unique_ptr<RecordWriter> record = record_for(options, setup);
  print_notes(setup.notes);  // of a scene that is not refused
  trial.record_to(record.get());
  const double started = cpu_seconds();
  const trial::TrialResult result = trial.run();
  if (record) record->close();
  if (terminal) fmt::print(stderr, "\r        \r");

  const RunReport report{setup,
                         trial.scene(),
                         result,
                         presses,
                         pushes,
                         fingers,
                         trial.has_world() ? trial.world().physics().elements() : 0,
                         started};
  if (!printed(options.json ? run_json(report) : run_text(report)) && StopSignals::caught() == 0)
    throw Error("standard output: the report could not be written; is the disk full, or the reader gone?");
  if (record && record->full()) throw Error(record->error());
  if (result.diverged_at >= 0)
    throw Error(
        fmt::format("the physics diverged at tick {}: {}; try a smaller {}.timestep_us", result.diverged_at,
                    result.divergence, setup.twin.stepping(setup.scene.arm.has_value()).table),
        {}, ErrorKind::device);
  if (StopSignals::caught() != 0) return 128 + StopSignals::caught();
  return result.last_mode == Mode::hold ? 4 : 0;
}

}  // namespace enc::app
