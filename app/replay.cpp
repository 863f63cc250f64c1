#include "core/record/replay.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "app/common/options.h"
#include "app/seen_again.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "trial/assemble/prepare.h"

namespace enc::app {

int replay(const ReplayOptions& options) {
  RecordReader record(options.record, options.partial ? Partial::yes : Partial::no);
  const models::Setup setup = models::setup_of(record.texts(), options.record);
  const Scene scene = trial::prepare_setup(setup);
  if (record.ticks() == 0)
    throw Error(fmt::format("{}: holds no whole tick{}; there is nothing to run again; record it again",
                            options.record, record.damage().empty() ? "" : " (" + record.damage() + ")"));
  std::optional<SeenAgain> again;  // before all else: nothing is said of what is refused
  if (!options.frames.empty()) again = see_again(setup, record, options.frames);
  const ReplayResult result = enc::replay(scene, record);
  if (result.first_difference >= 0) {
    fmt::print("differs from tick {} on: {}\n", result.first_difference, result.what);
    return 1;
  }
  fmt::print("{} run again, equal to the bit; state hash {:016x}{}\n", counted(result.ticks, "tick"),
             result.hash,
             record.sealed()           ? ""
             : record.damage().empty() ? " (record not sealed: it was cut off)"
                                       : "; damaged behind that, and not read: " + record.damage());
  if (const auto ledger = record.end_texts().find("ledger"); ledger != record.end_texts().end()) {
    const auto contacts = std::count(ledger->second.begin(), ledger->second.end(), '\n') - 1;
    fmt::print("energy ledger of {}, as the run had it: export --ledger\n", counted(contacts, "contact"));
  }
  if (again && again->first_difference >= 0) {
    fmt::print("vision differs from tick {} on: {}\n", again->first_difference, again->what);
    for (const std::string& line : again->said) fmt::print(stderr, "{}\n", line);
    return 1;
  }
  if (again) fmt::print("vision told {} what it told then, equal to the bit\n", counted(again->told, "time"));
  return record.damage().empty() ? 0 : 1;
}

}  // namespace enc::app
