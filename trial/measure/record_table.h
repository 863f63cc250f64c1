// A run as a table with named columns, for `encounter fit`, `encounter calibrate` and for programs that know
// nothing of Encounter (docs/guide/rig.md).
#pragma once

#include <string>
#include <string_view>

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
  void add_tool(std::string& row, const Stamped<TrackedTool>& tool);

  const Scene& scene_;
  std::string source_;         // of a push: what was pressed
  Time tool_t_ = Time::min();  // stamp of the newest packet of the tracker so far
};

// The whole run of a set-up, as `run --record` and `export` give it.
[[nodiscard]] std::string table_of_run(const models::Setup& setup, std::uint64_t seed);

}  // namespace enc::trial
