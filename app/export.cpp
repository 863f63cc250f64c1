// A record as a table, for programs that know nothing of Encounter (docs/rig.md). Row by row: a long record
// is never in memory as a whole.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "app/options.h"
#include "core/error.h"
#include "trial/measure/record_table.h"
#include "trial/prepare.h"

namespace enc::app {
namespace {

// The file, or standard output for "-".
class Output {
 public:
  explicit Output(const std::string& path)
      : path_(path), file_(path == "-" ? stdout : std::fopen(path.c_str(), "wb")) {
    if (file_ == nullptr) fail();
  }
  ~Output() {
    if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
  }
  void close() {
    std::FILE* file = std::exchange(file_, nullptr);
    if ((file == stdout ? std::fflush(file) : std::fclose(file)) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(fmt::format("{}: cannot be written: {}; choose a file in a folder that is yours and has room",
                            path_ == "-" ? "standard output" : path_, std::strerror(errno)));
  }
  std::string path_;
  std::FILE* file_;
};

}  // namespace

int export_record(const ExportOptions& options) {
  std::error_code none;
  if (std::filesystem::equivalent(options.record, options.csv, none))
    throw Error(options.csv + ": is the record itself; choose another file for the table");
  RecordReader record(options.record, options.partial ? Partial::yes : Partial::no);
  const models::Setup setup = models::setup_of(record.texts(), options.record);
  const Scene scene = trial::prepare_setup(setup);
  Output output(options.csv);
  trial::RecordTable table(setup, scene);
  output.write(trial::RecordTable::header());
  for (RecordedTick frame; record.next(frame);) output.write(table.row(frame.tick, frame.in, frame.out));
  output.close();
  return 0;
}

}  // namespace enc::app
