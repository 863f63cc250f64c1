#include "app/run/run_files.h"

#include <optional>
#include <string_view>

#include <sys/stat.h>
#include <unistd.h>

#include "app/run/live_run.h"
#include "app/run/run_report.h"
#include "app/stability_text.h"
#include "core/base/error.h"
#include "models/files.h"
#include "trial/mcap/mcap_writer.h"
#include "trial/mcap/record_mcap.h"
#include "trial/time/real_time.h"

namespace enc::app {
namespace {

// Refuses standard output as a file, because the report would be written into it. /dev/null is allowed.
void refuse_output(const std::string& path) {
  struct stat output {
  }, there{};
  if (fstat(STDOUT_FILENO, &output) != 0 || stat(path.c_str(), &there) != 0) return;
  if (output.st_dev != there.st_dev || output.st_ino != there.st_ino) return;
  if (S_ISCHR(output.st_mode) && isatty(STDOUT_FILENO) == 0) return;
  throw Error(path + ": is standard output, where the report goes; expected another file; choose one");
}

// The path itself, once it may be written.
const std::string& writable(const std::string& path) {
  for (const std::string& file : {path, path + ".part"}) refuse_output(file);
  return path;
}

RecordTexts texts_of(const RunOptions& options, const trial::Trial& trial, trial::WallTime started) {
  RecordTexts texts = models::record_texts(trial.setup());
  texts["scene"] = options.scene;
  texts["rig"] = trial.setup().rig_path;
  texts["seed"] = std::to_string(options.seed);
  texts.merge(trial::provenance_texts(started, trial.result().keeps_wall_time));
  texts["stability"] = stability_lines(trial.certificates());
  return texts;
}

}  // namespace

// A record, written to a temporary file until it is sealed.
struct RunFiles::Record {
  models::OutFile file;
  RecordWriter writer;
  std::optional<trial::RecordThread> thread;

  // beside: the run keeps the wall clock, so a separate thread writes to the disk and no tick waits for it.
  Record(const RunOptions& options, const RecordTexts& texts, const Scene& scene, bool beside)
      : file(writable(options.record), models::existing(options.force)),
        writer(file.aside(), texts, layout_hash(scene), beside ? RecordWriter::kManyChunks : 1,
               file.stream()) {
    if (beside) thread.emplace(writer);
  }
  void end(const RecordTexts& texts) {
    if (!texts.empty()) writer.end_with(texts);
    thread.reset();
    writer.close();
    if (!writer.full()) file.keep();
  }
};

// Equal to the export of the run's record.
struct RunFiles::Mcap {
  models::OutFile file;
  trial::McapWriter writer;
  trial::RecordMcap mcap;
  RecordedTick frame;

  Mcap(const RunOptions& options, const RecordTexts& texts, const trial::Trial& trial)
      : file(writable(options.mcap), models::existing(options.force)),
        writer([this](std::string_view bytes) { file.write(bytes); }, trial::program_words(),
               {.compression = trial::ChunkCompression::zstd}),
        mcap(writer, trial.setup(), trial.scene(), texts) {}
  void add(const trial::Glance& glance) {
    frame.tick = glance.tick;
    frame.in = glance.in;
    frame.out = glance.out;
    mcap.add(frame);
  }
  void end(const RecordTexts& texts) {
    mcap.end(texts, "whole");
    file.keep();
  }
};

RunFiles::RunFiles(const RunOptions& options) : options_(options) {}
RunFiles::~RunFiles() = default;

void RunFiles::begin(const trial::Trial& trial, trial::WallTime started) {
  const bool beside = trial.result().keeps_wall_time;
  if (beside && !options_.mcap.empty())
    throw Error(
        options_.mcap +
        ": --mcap would make the ticks of a run with real devices late; expected --record; export the record "
        "afterwards");
  const RecordTexts texts = texts_of(options_, trial, started);
  if (!options_.record.empty()) record_ = std::make_unique<Record>(options_, texts, trial.scene(), beside);
  if (!options_.mcap.empty()) mcap_ = std::make_unique<Mcap>(options_, texts, trial);
  if (!options_.live.empty()) live_ = std::make_unique<LiveRun>(live_address(options_.live), trial, texts);
  // Nothing is refused any more; from here on a killed run leaves a readable record.
  if (record_) record_->file.spare();
}

void RunFiles::watch(trial::TrialOptions& how) {
  if (options_.mcap.empty() && options_.live.empty()) return;
  how.watch = [this, counts = std::move(how.watch)](const trial::Glance& glance) {
    counts(glance);
    if (mcap_) mcap_->add(glance);
    if (live_) live_->add(glance);
  };
}

RecordWriter* RunFiles::record() { return record_ ? &record_->writer : nullptr; }

void RunFiles::end(const RecordTexts& texts) {
  if (record_) record_->end(texts);
  if (mcap_) mcap_->end(texts);
  if (live_) live_->end();
}

std::string RunFiles::record_error() const {
  return record_ && record_->writer.full() ? record_->writer.error() : std::string();
}

}  // namespace enc::app
