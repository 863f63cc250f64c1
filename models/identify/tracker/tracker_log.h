// A log of a tool that a machine carries past a tracker, as a file: comma-separated columns time_s,
// tip_x_mm.. (where the machine says the tip is, each row), tool_x_mm.. (the tracked tip of the tool, in rows
// where a new packet came) and, if known, tool_time_s (the packet's own stamp) and tip_time_s (the
// machine's). `encounter export` writes one.
#pragma once

#include <string>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

struct TrackerPacket {
  double time = kUnset;   // s: of the row in which it came
  double stamp = kUnset;  // s: when it says that it was true; unset: it does not say
  Vec3 tool{kUnset, kUnset, kUnset};
};

struct TrackerLog {
  std::vector<double> time;  // s, of the rows
  std::vector<Vec3> tip;     // m
  // s: when the machine says that it was there, which in the next row may be the same; unset: it does not
  // say. Empty: when the row was made.
  std::vector<double> tip_time;
  std::vector<TrackerPacket> packets;
  double period = kUnset;         // s between rows, median
  double packet_period = kUnset;  // s between packets, median
  bool repeated = false;          // the last value stands in every row: where it does not change nothing came
  std::vector<std::string> notes;
};

// Where the machine was at any time, and how fast.
class TipPath {
 public:
  explicit TipPath(const TrackerLog& log);
  // It was heard of on both sides, and not long before or after, within the log.
  [[nodiscard]] bool knows(double t) const;
  [[nodiscard]] Vec3 position(double t) const;
  [[nodiscard]] Vec3 velocity(double t) const;  // over a few rows: steps of an encoder are no speed

 private:
  [[nodiscard]] std::size_t after(double t) const;
  std::vector<double> time_;  // s
  std::vector<Vec3> tip_;     // m
  double first_, last_, period_, reach_;
};

// name: of the file, for messages "name:line:column: ...". rate: of the rows, Hz, as expected; unset: any.
// Throws Error: no such column, no number, time that does not go forwards, a rate that changes, a gap of more
// than 0.1 s, too little. Shorter gaps of whole rows, as of lost cycles, are counted in a note.
[[nodiscard]] TrackerLog parse_tracker_log(const std::string& text, const std::string& name,
                                           double rate = kUnset);

}  // namespace enc::models
