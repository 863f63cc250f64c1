// A log of a tool that is swung about its tip, as a file. Comma-separated columns time_s, tool_x_mm,
// tool_y_mm, tool_z_mm, tool_qx, tool_qy, tool_qz, tool_qw hold the pose of the markers T in the tracker's
// frame C, in rows with a new packet. If there is more than one tool, the column tool has its name. If
// tool_x_mm is something else, as in the table of `encounter export`, the columns markers_x_mm to markers_qw
// hold the pose.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "models/identify/tip/pivot_fit.h"

namespace enc::models {

struct PivotLog {
  std::string tool;  // its name; empty: the log has no name
  // Line of the header, for messages about the log as a whole.
  std::size_t line = 1;
  std::vector<PivotPose> poses;
};

// True if this text begins with the header of such a log, without a column tip_x_mm. A log with tip and tool
// is a log of a tracker (models/identify/tracker/tracker_log.h), though it may also have these columns.
[[nodiscard]] bool is_pivot_log(std::string_view text);

// name: of the file, for messages "name:line:column: ...". Throws Error: a missing column, not a number, a
// position beyond 10 m, a quaternion whose length is not 1 within 1e-3, time that does not increase, a second
// tool, a name of the tool that is not UTF-8.
[[nodiscard]] PivotLog parse_pivot_log(const std::string& text, const std::string& name);

// True if columns of mm seem to hold metres: the tip is then within 5 mm of the markers' origin, and all
// positions are within 20 mm of the tracker's, where it sees nothing. A tool with its origin at its tip, seen
// in a frame with its origin at the dimple, looks alike. So this is a doubt and not an error.
[[nodiscard]] bool looks_like_metres(const PivotLog& log, const PivotFit& fit);

}  // namespace enc::models
