// What a log's tool does beside what its tip does, one axis at a time: does the machine carry it?
#pragma once

#include <vector>

#include "models/identify/tracker/tracker_log.h"

namespace enc::models {

inline constexpr double kBlock = 0.25;  // s: errors farther apart than this are independent

// When the packets came (or say that they are of), how old they are taken to be, and which are not counted.
struct SeenAt {
  const std::vector<double>& times;  // s
  double age;                        // s
  const std::vector<bool>& left_out;
};

struct ToolMotion {
  double wander = 0.0;  // m: largest less least median of a block
  double noise = 0.0;   // m, rms, from one packet to the next
  double scale = 1.0;   // slope of the tool's place over the tip's
  // What the tip leaves of the tool's motion. Outliers included: a log of nothing else must not look good.
  double unexplained = 0.0;
};

[[nodiscard]] ToolMotion tool_motion(const TrackerLog& log, const TipPath& path, const SeenAt& seen,
                                     Eigen::Index axis);

}  // namespace enc::models
