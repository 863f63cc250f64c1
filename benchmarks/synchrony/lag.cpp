#include "benchmarks/synchrony/lag.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/base/frames.h"

namespace enc::bench::synchrony {
namespace {

using Signal = Eigen::Map<const Eigen::VectorXd>;

// Of the parts that lie over each other when `later` is drawn `shift` samples earlier. The same number of
// samples whatever the shift, so that none is favoured.
double correlation(const Signal& earlier, const Signal& later, Eigen::Index most, Eigen::Index shift) {
  const Eigen::Index n = earlier.size() - 2 * most;
  const Eigen::VectorXd a = earlier.segment(most, n).array() - earlier.segment(most, n).mean();
  const Eigen::VectorXd b = later.segment(most + shift, n).array() - later.segment(most + shift, n).mean();
  const double size = a.norm() * b.norm();
  return size > 0.0 ? a.dot(b) / size : kUnset;
}

}  // namespace

double lag_of(std::span<const double> earlier, std::span<const double> later, double period, double most) {
  const auto reach = static_cast<Eigen::Index>(std::llround(most / period));
  const auto n = static_cast<Eigen::Index>(std::min(earlier.size(), later.size()));
  if (reach < 1 || n < 4 * reach) return kUnset;
  const Signal a(earlier.data(), n);
  const Signal b(later.data(), n);
  std::vector<double> all;
  all.reserve(static_cast<std::size_t>(2 * reach + 1));
  for (Eigen::Index shift = -reach; shift <= reach; ++shift) all.push_back(correlation(a, b, reach, shift));
  const auto best = std::max_element(all.begin(), all.end());
  if (std::isnan(*best) || best == all.begin() || best + 1 == all.end()) return kUnset;
  const double before = *(best - 1), at = *best, after = *(best + 1);
  const double bend = before - 2.0 * at + after;
  const double between = bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
  return (static_cast<double>(best - all.begin()) + between - static_cast<double>(reach)) * period;
}

}  // namespace enc::bench::synchrony
