#include "models/identify/tracker/tool_motion.h"

#include <algorithm>
#include <cmath>

#include "models/order_statistics.h"

namespace enc::models {
namespace {

double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0.0, mean_y = 0.0, square = 0.0, product = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) mean_x += x[k] / n, mean_y += y[k] / n;
  for (std::size_t k = 0; k < x.size(); ++k) {
    square += (x[k] - mean_x) * (x[k] - mean_x);
    product += (x[k] - mean_x) * (y[k] - mean_y);
  }
  return product / square;
}

}  // namespace

ToolMotion tool_motion(const TrackerLog& log, const TipPath& path, const SeenAt& seen, Eigen::Index axis) {
  std::vector<double> tools, left, steps, good_tips, good_tools;
  std::vector<std::vector<double>> blocks;
  for (std::size_t k = 0; k < seen.times.size(); ++k) {
    const double t = seen.times[k] - seen.age;
    if (!path.knows(t)) continue;
    const double tool = log.packets[k].tool(axis), tip = path.position(t)(axis);
    if (!tools.empty()) steps.push_back(std::abs(tool - tools.back()));
    tools.push_back(tool);
    left.push_back(tool - tip);
    const auto block = static_cast<std::size_t>((t - log.time.front()) / kBlock);
    if (block >= blocks.size()) blocks.resize(block + 1);
    blocks[block].push_back(tool);
    if (!seen.left_out[k]) good_tips.push_back(tip), good_tools.push_back(tool);
  }
  // A block that lost most of its packets is no median.
  std::size_t full = 0;
  for (const std::vector<double>& block : blocks) full = std::max(full, block.size());
  double low = INFINITY, high = -INFINITY;
  for (const std::vector<double>& block : blocks) {
    if (block.empty() || 3 * block.size() < full) continue;
    low = std::min(low, median(block));
    high = std::max(high, median(block));
  }
  return {std::max(0.0, high - low), 1.4826 / std::sqrt(2.0) * median(steps), slope(good_tips, good_tools),
          spread(left) / spread(tools)};
}

}  // namespace enc::models
