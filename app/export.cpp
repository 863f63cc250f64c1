// A record as a table, for programs that know nothing of Encounter (docs/guide/rig.md). Row by row: a long
// record is never in memory as a whole.
#include <cstdio>
#include <memory>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "app/options.h"
#include "app/process.h"
#include "app/run/stop_signals.h"
#include "models/files.h"
#include "trial/assemble.h"
#include "trial/measure/record_table.h"
#include "trial/prepare.h"

namespace enc::app {
namespace {

// The file, or standard output for "-".
class Output {
 public:
  Output(const std::string& path, models::Existing existing) {
    if (path != "-") file_.emplace(path, existing);
  }
  void write(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() > 1U << 16U) flush();
  }
  void end() {
    flush();
    if (file_) file_->keep();
  }

 private:
  void flush() {
    if (file_)
      file_->write(buffer_);
    else if (std::fwrite(buffer_.data(), 1, buffer_.size(), stdout) != buffer_.size())
      fail_output();
    buffer_.clear();
  }
  std::optional<models::OutFile> file_;
  std::string buffer_;
};

// The world at its start, with all that is only looked at.
int export_world(const ExportOptions& options) {
  const models::Setup setup = models::load(options.record, "");
  const Scene scene = trial::prepare_setup(setup);
  const std::unique_ptr<sim::World> world = trial::make_world(setup, scene, 1, true);
  models::OutFile file(options.xml, models::existing(options.force));
  file.write(world->physics().xml());
  file.keep();
  return 0;
}

}  // namespace

int export_record(const ExportOptions& options) {
  if (!options.xml.empty()) return export_world(options);
  models::note_input(options.record);
  RecordReader record(options.record, options.partial ? Partial::yes : Partial::no);
  const models::Setup setup = models::setup_of(record.texts(), options.record);
  const Scene scene = trial::prepare_setup(setup);
  // A pipe without a reader ends this as it ends others.
  std::optional<StopSignals> signals;
  if (options.csv != "-") signals.emplace();
  Output output(options.csv, models::existing(options.force));
  trial::RecordTable table(setup, scene);
  output.write(trial::RecordTable::header());
  for (RecordedTick frame; record.next(frame);) {
    output.write(table.row(frame.tick, frame.in, frame.out));
    if (signals && StopSignals::caught() != 0) return 128 + StopSignals::caught();  // half a table is none
  }
  output.end();
  if (!record.damage().empty())
    fmt::print(stderr, "encounter: {}: {}; only the {} ticks before it are in the table\n", options.record,
               record.damage(), record.ticks());
  return record.damage().empty() ? 0 : 1;
}

}  // namespace enc::app
