#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <encounter_version.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/built.h"
#include "app/modules/modules.h"
#include "app/options.h"
#include "app/process.h"
#include "app/run/hand.h"
#include "app/run/run_report.h"
#include "app/run/stop_signals.h"
#include "app/run/verdict.h"
#include "app/stability_text.h"
#include "core/error.h"
#include "models/files.h"
#include "trial/run_measures.h"
#include "trial/time/record_thread.h"
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

// The report would be written into it. What throws away both is no harm.
void refuse_output(const std::string& path) {
  struct stat output {
  }, there{};
  if (fstat(STDOUT_FILENO, &output) != 0 || stat(path.c_str(), &there) != 0) return;
  if (output.st_dev != there.st_dev || output.st_ino != there.st_ino) return;
  if (S_ISCHR(output.st_mode) && isatty(STDOUT_FILENO) == 0) return;
  throw Error(path + ": is standard output, where the report goes; expected another file; choose one");
}

// A record, beside its place until it is sealed.
struct Recording {
  models::OutFile file;
  RecordWriter writer;
  std::optional<trial::RecordThread> thread;

  // beside: the run keeps the wall clock, and no tick may wait for a disk.
  Recording(const RunOptions& options, const RecordTexts& texts, const Scene& scene, bool beside)
      : file(options.record, models::existing(options.force)),
        writer(file.aside(), texts, layout_hash(scene), beside ? RecordWriter::kManyChunks : 1) {
    file.spare();  // what a run that does not end has recorded is readable
    if (beside) thread.emplace(writer);
  }
  void end() {
    thread.reset();
    writer.close();
    if (!writer.full()) file.keep();
  }
};

std::unique_ptr<Recording> record_for(const RunOptions& options, const models::Setup& setup,
                                      const trial::Trial& trial,
                                      const std::vector<trial::Certified>& certificates) {
  if (options.record.empty()) return nullptr;
  for (const std::string& path : {options.record, options.record + ".part"}) refuse_output(path);
  RecordTexts texts = models::record_texts(setup);
  texts["scene"] = options.scene;
  texts["rig"] = setup.rig_path;
  texts["seed"] = std::to_string(options.seed);
  texts["version"] = ENCOUNTER_VERSION;
  texts["stability"] = stability_lines(certificates);
  return std::make_unique<Recording>(options, texts, trial.scene(), trial.result().keeps_wall_time);
}

// Said before anything moves.
std::vector<std::string> beyond(const models::Setup& setup,
                                const std::vector<trial::Certified>& certificates) {
  std::vector<std::string> lines;
  for (const trial::Certified& one : certificates)
    if (one.beyond()) lines.push_back("beyond what is stable: " + trial::refusal_text(setup, one));
  return lines;
}

int diverged(const trial::TrialResult& result, const models::Setup& setup) {
  fmt::print(stderr, "encounter: the physics diverged at tick {}: {}; try a smaller {}.timestep_us\n",
             result.diverged_at, result.divergence, setup.twin.stepping(setup.scene.arm.has_value()).table);
  return 4;
}

}  // namespace

int run(const RunOptions& options) {
  const StopSignals signals;  // from here on: devices are let go, whenever it comes
  const models::Setup setup = load_setup(options);
  if (options.seconds && !(*options.seconds > 0.0 && *options.seconds < 1e6))
    throw Error("--for-s: expected a positive number of seconds below a million");
  trial::TrialOptions trial_options;
  trial::RunMeasures measured(setup, trial_options);
  trial_options.seed = options.seed;
  trial_options.seconds = options.seconds.value_or(kUnset);
  trial_options.pace = pace_of(options.pace);
  trial_options.drivers = load_module;
  trial_options.armed = options.armed;
  trial_options.lockstep = options.lockstep;
  trial_options.real_time = true;  // dry, too: what is late holds
  trial_options.frames = options.frames;
  HandAtTheRun hand;
  trial_options.stop = [&hand] { return StopSignals::caught() != 0 || hand.quits(); };
  trial_options.hand = [&hand] { return hand.next(); };
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal) trial_options.progress = show_progress;
  trial::Trial trial(
      setup, trial_options);  // everything that can be refused is refused here, before a record is begun
  const std::vector<trial::Certified> certificates = trial::certificates_of(setup, trial.scene());
  const std::unique_ptr<Recording> record = record_for(options, setup, trial, certificates);
  print_notes(setup.notes);  // of a scene that is not refused
  print_notes(beyond(setup, certificates));
  trial.record_to(record ? &record->writer : nullptr);
  if (hand.reads_keys() && options.armed) fmt::print(stderr, "space stops, r resumes, q ends\n");
  const double started = cpu_seconds();
  const trial::TrialResult result = trial.run();
  if (terminal) fmt::print(stderr, "\r        \r");

  const std::vector<trial::ArmStrength> strengths = trial::strengths_of(setup, trial.scene());
  RunReport report{setup,
                   trial.scene(),
                   result,
                   measured,
                   strengths,
                   certificates,
                   options,
                   trial.has_world() ? trial.world().physics().steps() : 0,
                   trial.has_world() ? trial.world().physics().unsolved() : 0,
                   !options.seconds && !result.interrupted && !result.stopped && result.diverged_at < 0,
                   trial.has_world() ? trial.world().physics().elements() : 0,
                   started};
  report.crossed = crossed(report);
  const std::string text = options.json ? run_json(report) : run_text(report);
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);  // while a pipe without a reader is an error only
  if (record) {
    if (const auto contacts = measured.ledger.contacts(); !contacts.empty())
      record->writer.end_with({{"ledger", trial::ledger_table(contacts)}});
    record->end();
  }
  if (record && record->writer.full())
    throw Error(record->writer.error() + "; replay --partial reads what was written");
  if (result.diverged_at >= 0) return diverged(result, setup);
  if (StopSignals::caught() != 0) return 128 + StopSignals::caught();
  if (result.last_mode == Mode::hold) return 4;
  return report.crossed.empty() ? 0 : 1;
}

}  // namespace enc::app
