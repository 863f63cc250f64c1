#include "trial/identify/read_table.h"

#include <filesystem>
#include <string_view>

#include "core/base/error.h"
#include "core/record/record.h"
#include "models/tables/csv_reader.h"
#include "trial/assemble/prepare.h"
#include "trial/measure/record_table.h"

namespace enc::trial {
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

std::string read_table(const std::string& path, const std::string& kind, const std::string& expected) {
  std::error_code none;  // a pipe is a table: what is read of it to see what it is would be gone
  if (!std::filesystem::is_regular_file(path, none) || !is_record(path))
    return models::csv_text(path, kind, expected);
  RecordReader record = whole_record(path);
  const models::Setup setup = models::setup_of(record.texts(), path);
  const Scene scene = prepare_setup(setup);
  RecordTable table(setup, scene);
  std::string text(RecordTable::header());
  RecordedTick frame;
  while (record.next(frame)) text += table.row(frame.tick, frame.in, frame.out);
  return text;
}

}  // namespace enc::trial
