// A log of a tool that is swung about its tip, as a file: comma-separated columns time_s, tool_x_mm,
// tool_y_mm, tool_z_mm, tool_qx, tool_qy, tool_qz, tool_qw (the pose of the markers T in the tracker's frame
// C, in rows in which a new packet came) and, if there is more than one, tool: its name. Where tool_x_mm is
// something else, as in the table that `encounter export` writes, the same are markers_x_mm to markers_qw.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "models/identify/tip/pivot_fit.h"

namespace enc::models {

struct PivotLog {
  std::string tool;      // its name; empty: the log has none
  std::size_t line = 1;  // of the header, for messages about the log as a whole
  std::vector<PivotPose> poses;
};

// Does this text begin with the header of such a log, and have no column tip_x_mm? With tip and tool it is a
// log of a tracker (models/identify/tracker/tracker_log.h), though it may hold these columns as well.
[[nodiscard]] bool is_pivot_log(std::string_view text);

// name: of the file, for messages "name:line:column: ...". Throws Error: no such column, no number, a place
// beyond 10 m, a quaternion whose length is not 1 within 1e-3, time that does not go forwards, a second tool,
// a name of the tool that is not UTF-8.
[[nodiscard]] PivotLog parse_pivot_log(const std::string& text, const std::string& name);

// Are these metres in columns of mm? Then the tip is within 5 mm of the markers' origin and all places are
// within 20 mm of the tracker's, where it sees nothing. A tool that has its origin at its tip, seen in a
// frame that has its origin at the dimple, looks alike, so this is a doubt and no mistake.
[[nodiscard]] bool looks_like_metres(const PivotLog& log, const PivotFit& fit);

}  // namespace enc::models
