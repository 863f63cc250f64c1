// What `fit` and `calibrate` read: a table, or a record, which is made one as `encounter export` makes it.
#include <filesystem>
#include <string_view>

#include "app/fit/commands.h"
#include "core/base/error.h"
#include "core/record/record.h"
#include "models/tables/csv_reader.h"
#include "trial/assemble/prepare.h"
#include "trial/measure/record_table.h"

namespace enc::app {
namespace {

// Half of a log is another log: what is cut off is read by export, which says so.
RecordReader whole_record(const std::string& path) {
  try {
    return RecordReader(path);
  } catch (const Error& e) {
    constexpr std::string_view kPartial = "give --partial for what is whole";
    std::string what = e.what();
    const auto advice = what.find(kPartial);
    if (advice == std::string::npos) throw;
    what.replace(advice, kPartial.size(),
                 "`encounter export RECORD --partial --csv FILE` writes what is whole as a table");
    throw Error(what, e.key());
  }
}

}  // namespace

std::string read_table(const std::string& path, const std::string& what, const std::string& expected) {
  std::error_code none;  // a pipe is a table: what is read of it to see what it is would be gone
  if (!std::filesystem::is_regular_file(path, none) || !is_record(path))
    return models::csv_text(path, what, expected);
  RecordReader record = whole_record(path);
  const models::Setup setup = models::setup_of(record.texts(), path);
  const Scene scene = trial::prepare_setup(setup);
  trial::RecordTable table(setup, scene);
  std::string text(trial::RecordTable::header());
  RecordedTick frame;
  while (record.next(frame)) text += table.row(frame.tick, frame.in, frame.out);
  return text;
}

}  // namespace enc::app
