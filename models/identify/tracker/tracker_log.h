// A log of a tool that a machine carries past a tracker, as a file. Comma-separated columns time_s,
// tip_x_mm.. (the machine's tip, each row), tool_x_mm.. (the tracked tip of the tool, in rows with a new
// packet) and, if known, tool_time_s (the packet's own stamp) and tip_time_s (the machine's). `encounter
// export` writes one.
#pragma once

#include <string>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

struct TrackerPacket {
  double time = kUnset;   // s: time of the row in which it came
  double stamp = kUnset;  // s: its own stamp; unset: no stamp
  Vec3 tool{kUnset, kUnset, kUnset};
};

struct TrackerLog {
  std::vector<double> time;  // s, of the rows
  std::vector<Vec3> tip;     // m
  // s: the machine's own stamps, of which the next row may repeat one; unset: no stamp. Empty: the rows'
  // times.
  std::vector<double> tip_time;
  std::vector<TrackerPacket> packets;
  double period = kUnset;         // s between rows, median
  double packet_period = kUnset;  // s between packets, median
  bool repeated = false;          // the last value is in every row: without a change there was no new packet
  std::vector<std::string> notes;
};

// Position and velocity of the machine at any time.
class TipPath {
 public:
  explicit TipPath(const TrackerLog& log);
  // True if the machine reported shortly before and after this time, within the log.
  [[nodiscard]] bool knows(double t) const;
  [[nodiscard]] Vec3 position(double t) const;
  [[nodiscard]] Vec3 velocity(double t) const;  // over a few rows: encoder steps are not a speed

 private:
  [[nodiscard]] std::size_t after(double t) const;
  std::vector<double> time_;  // s
  std::vector<Vec3> tip_;     // m
  double first_, last_, period_, reach_;
};

// name: of the file, for messages "name:line:column: ...". rate: expected rate of the rows, Hz; unset: any.
// Throws Error: a missing column, not a number, time that does not increase, a rate that changes, a gap of
// more than 0.1 s, too little data. Shorter gaps of whole rows, as from lost cycles, are counted in a note.
[[nodiscard]] TrackerLog parse_tracker_log(const std::string& text, const std::string& name,
                                           double rate = kUnset);

}  // namespace enc::models
