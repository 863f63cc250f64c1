// Checks whether the machine carries the tool: compares the motions of a log's tool and tip, one axis at a
// time.
#pragma once

#include <vector>

#include "models/identify/tracker/tracker_log.h"

namespace enc::models {

inline constexpr double kBlock = 0.25;  // s: errors farther apart than this are independent

// Arrival times of the packets (or their stamps), their assumed age, and the ones not counted.
struct SeenAt {
  const std::vector<double>& times;  // s
  double age;                        // s
  const std::vector<bool>& left_out;
};

struct ToolMotion {
  double wander = 0.0;  // m: largest minus smallest median of a block
  double noise = 0.0;   // m, rms, from one packet to the next
  double scale = 1.0;   // slope of the tool's position over the tip's
  // Part of the tool's motion that the tip does not explain. It includes outliers, so that a log with only
  // outliers does not look good.
  double unexplained = 0.0;
};

[[nodiscard]] ToolMotion tool_motion(const TrackerLog& log, const TipPath& path, const SeenAt& seen,
                                     Eigen::Index axis);

}  // namespace enc::models
