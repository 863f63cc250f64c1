// A run as a table with named columns, for `encounter fit`, `encounter calibrate` and for programs that know
// nothing of Encounter (docs/guide/rig.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/record/record.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

class RecordTable {
 public:
  RecordTable(const models::Setup& setup, const Scene& scene);

  // Comma-separated, each with its newline. A number is the shortest text that reads back to it; nothing
  // where it is not known.
  [[nodiscard]] static std::string_view header();
  [[nodiscard]] std::string row(const Tick& tick, const Inputs& in, const Outputs& out);  // in order

 private:
  bool news(const Stamped<TrackedTool>& tool);  // of the tracker, since the last row
  void add_tip(std::string& row, const Stamped<TrackedTool>& tool) const;
  void add_markers(std::string& row, const TrackedTool& tool) const;

  const Scene& scene_;
  std::string source_;              // of a push: what was pressed
  std::vector<std::string> tools_;  // their names
  Time tool_t_ = Time::min();       // stamp of the newest packet of the tracker so far
};

// The whole run of a set-up, as `run --record` and `export` give it.
[[nodiscard]] std::string table_of_run(const models::Setup& setup, std::uint64_t seed);

}  // namespace enc::trial
