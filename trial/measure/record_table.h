// A run as a table with named columns, for `encounter fit`, `encounter calibrate` and external programs
// (docs/guide/rig.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/record.h"
#include "sim/truth/truth.h"
#include "trial/family.h"

namespace enc::trial {

// Pressing force on the object, N. A probe's force is that measured in this tick, unfiltered. A contact's
// force is the filtered one that the object answers to.
[[nodiscard]] double pressing_force(const Scene& scene, const Outputs& out);
// Number of the push or contact in a tick; 0: neither.
[[nodiscard]] std::int32_t contact_number(const Outputs& out);

class RecordTable {
 public:
  RecordTable(const models::Setup& setup, const Scene& scene);

  // Comma-separated, each with its newline. A number is the shortest text that reads back to it; an unknown
  // number is empty.
  [[nodiscard]] static std::string_view header();
  [[nodiscard]] std::string row(const Tick& tick, const Inputs& in, const Outputs& out);  // in order

  // The same with further columns, the twin's ground truth.
  [[nodiscard]] static std::string header_with_truth();
  [[nodiscard]] static std::string with_truth(std::string row, const sim::Truth& truth);

 private:
  // True if the tracker has a new pose since the last row.
  bool news(const Measurement<TrackedTool>& tool);
  void add_tip(std::string& row, const Measurement<TrackedTool>& tool) const;
  void add_markers(std::string& row, const TrackedTool& tool) const;

  const Scene& scene_;
  const Family& family_;
  std::string source_;              // push only: the pressed object
  std::vector<std::string> tools_;  // names
  Time tool_t_ = Time::min();       // stamp of the tracker's newest packet so far
};

// The whole run of a set-up, as `run --record` and `export` write it.
[[nodiscard]] std::string table_of_run(const models::Setup& setup, std::uint64_t seed);

// Text of the table that a fit reads: a CSV file, or a record in the form of `encounter export`. kind,
// expected: words about the table for the message of an unreadable file. Throws Error, also for a truncated
// record.
[[nodiscard]] std::string read_table(const std::string& path, const std::string& kind,
                                     const std::string& expected);

}  // namespace enc::trial
