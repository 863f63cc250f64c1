// Percentiles of a run's frequent measurements, as text. A percentile with too few values is left out.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "models/order_statistics.h"
#include "trial/operator/run_watch.h"

namespace enc::app {

// NaN: too few values (has_percentile). `most` is NaN without values.
struct Percentiles {
  double p50 = kUnset, p99 = kUnset, p99_9 = kUnset, most = kUnset;
};

template <class T>
[[nodiscard]] Percentiles percentiles_of(const std::vector<T>& values) {
  return {models::known_percentile(values, 0.5), models::known_percentile(values, 0.99),
          models::known_percentile(values, 0.999), models::percentile(values, 1.0)};
}

// The last periods of a run, ns.
[[nodiscard]] inline Percentiles periods_of(const trial::RunStatus& status) {
  const std::size_t count = std::min(status.periods, trial::RunStatus::kPeriods);
  return percentiles_of(std::vector<std::uint32_t>(
      status.periods_ns.begin(), status.periods_ns.begin() + static_cast<std::ptrdiff_t>(count)));
}

// "p50 0.66, p99 1.23, p99.9 1.68, max 73.8". `scale`: factor from the unit of the values. Without values:
// "none".
[[nodiscard]] inline std::string text_of(const Percentiles& of, double scale, int decimals, int of_most) {
  if (std::isnan(of.most)) return "none";
  std::string text;
  for (const auto& [name, value] : {std::pair{"p50", of.p50}, {"p99", of.p99}, {"p99.9", of.p99_9}})
    if (!std::isnan(value)) text += fmt::format("{} {:.{}f}, ", name, value * scale, decimals);
  return text + fmt::format("max {:.{}f}", of.most * scale, of_most);
}

}  // namespace enc::app
