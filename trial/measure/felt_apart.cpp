#include "trial/measure/felt_apart.h"

#include <algorithm>
#include <cmath>

namespace enc::trial {
FeltApart felt_apart(const FeltWay& one, const FeltWay& other, std::size_t frame) {
  FeltApart apart;
  std::vector<double> sums{0.0};  // of the differences since both came into contact
  const std::size_t ticks = std::min(one.felt().size(), other.felt().size());
  for (std::size_t i = 0; i < ticks; ++i) {
    const double difference = other.felt()[i] - one.felt()[i];
    if (std::isnan(difference)) {
      sums.resize(1);
      continue;
    }
    ++apart.ticks;
    apart.tick = std::max(apart.tick, std::abs(difference));
    sums.push_back(sums.back() + difference);
    if (sums.size() <= frame) continue;
    const double mean = std::abs(sums.back() - sums[sums.size() - 1 - frame]) / static_cast<double>(frame);
    apart.frame = std::max(apart.frame, mean);
  }
  return apart;
}

}  // namespace enc::trial
