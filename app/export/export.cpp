// Exports a record as a table or as MCAP, for other programs (docs/guide/rig.md). It works tick by tick, so a
// long record is never in memory as a whole.
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "app/built.h"
#include "app/common/options.h"
#include "app/common/words.h"
#include "app/process.h"
#include "app/text_output.h"
#include "app/view/recorded/source.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/wording.h"
#include "trial/assemble/assemble.h"
#include "trial/mcap/mcap_writer.h"
#include "trial/mcap/record_mcap.h"
#include "trial/measure/record_table.h"
#include "trial/operator/signals.h"
#include "trial/provenance/provenance.h"

namespace enc::app {
namespace {

// Refuses options of a table for a world, and options of a world for a table.
void refuse_others(const ExportOptions& options) {
  const auto refuse = [](bool there, const std::string& option, const char* of, const char* instead) {
    if (there) throw Error(option + ": only of " + of + "; expected " + instead + "; leave it out");
  };
  if (options.xml.empty()) {
    constexpr const char* kInstead = "a record alone, which has all that it was made with";
    refuse(!options.rig.empty(), "--rig", "a scene that is written as MJCF", kInstead);
    refuse(!options.set.empty(), "--set", "a scene that is written as MJCF", kInstead);
    if (options.record.ends_with(".toml"))
      throw Error(
          options.record +
          ": is a scene, and nothing says where its world shall go; expected a record, or a scene and "
          "a file; name one, such as world.xml");
    refuse(options.truth && options.ledger, "--truth", "the table of ticks",
           "one of them, because the ledger is ground truth already");
    if (options.mcap.empty()) return;
    constexpr const char* kAlone = "one of them at a time";
    refuse(!options.csv.empty(), "--csv", "a table, and --mcap is given", kAlone);
    refuse(options.ledger, "--ledger", "a table, and --mcap is given, which has the ledger, too", kAlone);
    refuse(options.truth, "--truth", "a table, and --mcap is given", kAlone);
    return;
  }
  constexpr const char* kInstead = "a scene and the file that its world is written to";
  refuse(!options.csv.empty(), "--csv", "a record that is written as a table", kInstead);
  refuse(!options.mcap.empty(), "--mcap", "a record that is written as MCAP", kInstead);
  refuse(options.partial, "--partial", "a record that is written as a table", kInstead);
  refuse(options.ledger, "--ledger", "a record: a scene has no ledger before it has run", kInstead);
  refuse(options.truth, "--truth", "a record that is written as a table", kInstead);
  if (options.xml == "-")
    throw Error("-: a world is not written to standard output; expected a file; name one, such as world.xml");
  if (is_record(options.record))
    throw Error(options.record + ": is a record, and '" + options.xml +
                "' asks for a world; expected a scene file (models/scenes/*.toml); name one, or write the "
                "record as a table with --csv");
}

// Writes the world at its start, including the parts that are only for show.
int export_world(const ExportOptions& options) {
  const models::Setup setup = models::load(options.record, options.rig, options.set);
  print_notes(setup.notes);
  const Scene scene = trial::prepare_setup(setup);
  const std::unique_ptr<sim::World> world = trial::make_world(setup, scene, 1, true);
  models::OutFile file(options.xml, models::existing(options.force));
  file.write(world->physics().xml());
  file.keep();
  return 0;
}

// The energy balance as the run computed it. It is ground truth, which the record's ticks do not contain.
std::string ledger_of(const RecordReader& record, const std::string& path) {
  const auto ledger = record.end_texts().find("ledger");
  if (ledger != record.end_texts().end()) {
    std::istringstream lines(ledger->second);
    std::string text;
    for (std::string line; std::getline(lines, line);) text += models::printable(line) + "\n";
    return text;
  }
  throw Error(path + ": has no energy ledger" +
              (!record.damage().empty() ? ": " + record.damage() + "; record it again"
               : record.sealed()
                   ? ": nothing that was rendered was touched, a real machine ran, or an older version "
                     "wrote it; record it again"
                   : ": the end, where it stands, is missing (the run was killed, or the file was cut off); "
                     "record it again") +
              ", or leave out --ledger");
}

// Passes all ticks to `take`; returns false if a signal came before the last tick, because half a file is
// useless.
template <class Take>
bool take_all(RecordReader& record, bool stoppable, const Take& take) {
  for (RecordedTick frame; record.next(frame);) {
    take(frame);
    if (stoppable && trial::Signals::caught() != 0) return false;
  }
  return true;
}

bool write_mcap(const ExportOptions& options, RecordReader& record, const models::Setup& setup,
                const Scene& scene) {
  models::OutFile out(options.mcap, models::existing(options.force));
  using trial::ChunkCompression, trial::McapMessages;
  trial::McapWriter file(
      [&](std::string_view bytes) { out.write(bytes); }, trial::program_words(),
      {.compression = options.uncompressed ? ChunkCompression::none : ChunkCompression::zstd,
       .profile = options.ros2 ? "ros2" : ""});
  trial::RecordMcap mcap(file, setup, scene, record.texts(),
                         options.ros2 ? McapMessages::ros2 : McapMessages::json);
  if (!take_all(record, true, [&](const RecordedTick& frame) { mcap.add(frame); })) return false;
  const std::string lack = lack_of(record, "file");
  mcap.end(record.end_texts(), lack.empty() ? "whole" : lack);
  out.keep();
  return true;
}

bool write_table(const ExportOptions& options, const std::string& csv, bool stoppable, RecordReader& record,
                 const models::Setup& setup, const Scene& scene) {
  TextOutput output(csv, models::existing(options.force));
  trial::RecordTable table(setup, scene);
  output.write(trial::RecordTable::header());
  const auto row = [&](const RecordedTick& frame) {
    output.write(table.row(frame.tick, frame.in, frame.out));
  };
  if (!take_all(record, stoppable, row)) return false;
  output.end();
  return true;
}

template <std::size_t N>
bool same_bits(const std::array<double, N>& a, const std::array<double, N>& b) {
  using Bits = std::array<std::uint64_t, N>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

// True if the twin's machine and sensor reported the recorded bits at the recorded time: its truth is then
// that of the run.
bool repeats(const trial::Trial& twin, const RecordedTick& frame) {
  const Inputs &now = twin.inputs(), &then = frame.in;
  return twin.now().t == frame.tick.t && twin.result().hash == frame.hash &&
         same_bits(now.tip.value.X_RH.xyz, then.tip.value.X_RH.xyz) &&
         same_bits(now.wrench.value.force.xyz, then.wrench.value.force.xyz) &&
         same_bits(now.arm.value.joints, then.arm.value.joints);
}

bool write_truth(const ExportOptions& options, const std::string& csv, bool stoppable) {
  Playback twin(options.record);
  constexpr const char* kRemedy = "leave out --truth";
  if (!twin.simulated())
    throw Error(
        fmt::format("{}: has no ground truth: a device was real, or the record does not say how its hand was "
                    "steered; expected a whole record of the twin; {}",
                    options.record, kRemedy));
  TextOutput output(csv, models::existing(options.force));
  trial::RecordTable table(twin.setup(), twin.trial().scene());
  output.write(trial::RecordTable::header_with_truth());
  std::string row;
  const auto see = [&](const trial::Glance& glance) {
    row = trial::RecordTable::with_truth(table.row(glance.tick, glance.in, glance.out), glance.truth);
  };
  while (twin.next(see)) {
    if (stoppable && trial::Signals::caught() != 0) return false;
    if (!repeats(twin.trial(), twin.frame()))
      throw Error(fmt::format(
          "{}: the twin does not repeat the run from tick {} on; expected a record of this version "
          "that was not made on the wall clock; {}",
          options.record, twin.frame().tick.index, kRemedy));
    output.write(row);
  }
  output.end();
  return true;
}

}  // namespace

int export_record(const ExportOptions& options) {
  refuse_others(options);
  if (!options.xml.empty()) return export_world(options);
  const std::string csv = options.csv.empty() ? "-" : options.csv;
  const bool mcap = !options.mcap.empty();
  models::note_input(options.record);
  RecordReader record(options.record, options.partial ? PartialRead::yes : PartialRead::no);
  const models::Setup setup = models::setup_of(record.texts(), options.record);
  const Scene scene = trial::prepare_setup(setup);
  const std::string ledger = options.ledger ? ledger_of(record, options.record) : "";
  // Without signal handling, a pipe without a reader ends this process as usual.
  std::optional<trial::Signals> signals;
  if (mcap || csv != "-") signals.emplace().begin();
  std::string lack;
  if (options.ledger) {
    TextOutput output(csv, models::existing(options.force));
    output.write(ledger);
    output.end();
    if (!record.damage().empty()) lack = record.damage() + "; the ledger is as it was read";
  } else {
    const bool whole = mcap            ? write_mcap(options, record, setup, scene)
                       : options.truth ? write_truth(options, csv, signals.has_value())
                                       : write_table(options, csv, signals.has_value(), record, setup, scene);
    if (!whole) return 128 + trial::Signals::caught();
    lack = lack_of(record, mcap ? "file" : "table");
  }
  if (!lack.empty()) fmt::print(stderr, "encounter: {}: {}\n", options.record, lack);
  return record.damage().empty() ? 0 : 1;
}

}  // namespace enc::app
