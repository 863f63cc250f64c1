#include "benchmarks/kit/cost.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <random>
#include <utility>

#include "benchmarks/kit/statistics.h"

namespace enc::bench {

Race::Race(std::size_t rounds, const std::vector<std::function<void()>>& ways, std::size_t warm_up,
           std::uint64_t seed)
    : seconds_(ways.size()) {
  std::vector<std::size_t> order(ways.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 random(seed);
  for (std::size_t round = 0; round < warm_up + rounds; ++round) {
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t way : order) {
      const double start = thread_seconds();
      ways[way]();
      if (round >= warm_up) seconds_[way].push_back(thread_seconds() - start);
    }
  }
}

double Race::seconds(std::size_t way, double share) const { return percentile(seconds_.at(way), share); }

double Race::ratio(std::size_t way, const Race& race, std::size_t over) const {
  std::vector<double> ratios = seconds_.at(way);
  for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] /= race.seconds_.at(over).at(i);
  return median(ratios);
}

double Race::more(std::size_t way, std::size_t over) const {
  std::vector<double> apart = seconds_.at(way);
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i] -= seconds_.at(over).at(i);
  return trimmed_mean(std::move(apart)).mean;
}

TrimmedMean trimmed_mean(std::vector<double> numbers) {
  if (numbers.empty()) return {};
  std::sort(numbers.begin(), numbers.end());
  const auto cut = static_cast<std::ptrdiff_t>(numbers.size() / 20);
  const auto from = numbers.begin() + cut, to = numbers.end() - cut;
  const auto n = static_cast<double>(to - from);
  TrimmedMean of{std::accumulate(from, to, 0.0) / n};
  // Each trimmed value counts as the outermost value that is left (Tukey and McLaughlin 1963).
  double squares =
      static_cast<double>(cut) * (std::pow(*from - of.mean, 2) + std::pow(*(to - 1) - of.mean, 2));
  for (auto at = from; at != to; ++at) squares += std::pow(*at - of.mean, 2);
  const auto all = static_cast<double>(numbers.size());
  of.doubt = std::sqrt(squares / (all - 1.0)) * std::sqrt(all) / n;
  return of;
}

double fitted_order(const std::vector<double>& steps, const std::vector<double>& errors, double floor) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!(errors.at(i) > 3.0 * floor)) continue;
    const double a = std::log(steps[i]), b = std::log(errors[i]);
    n += 1.0;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return n < 3.0 ? kUnset : (n * xy - x * y) / (n * xx - x * x);
}

Plot cost_beside_error(Plot plot, const std::vector<CostCurve>& curves,
                       const std::vector<ErrorLevel>& levels) {
  plot.log_x = plot.log_y = true;
  std::vector<double> costs;
  for (const CostCurve& curve : curves)
    std::copy_if(curve.cost.begin(), curve.cost.end(), std::back_inserter(costs),
                 [](double cost) { return std::isfinite(cost); });
  for (const CostCurve& curve : curves) {
    Series there{.name = curve.name, .mark = Mark::both};
    Series failed{.name = "", .mark = Mark::crosses};
    for (std::size_t i = 0; i < curve.cost.size(); ++i)
      if (std::isfinite(curve.cost[i]))  // no cost if it was refused before it ran
        (std::isnan(curve.error[i]) ? failed : there).add(curve.cost[i], curve.error[i]);
    plot.series.push_back(std::move(there));
    if (!failed.x.empty()) plot.series.push_back(std::move(failed));
  }
  for (const ErrorLevel& level : levels) {
    if (costs.empty() || !(level.error > 0.0)) continue;
    const auto [least, most] = std::minmax_element(costs.begin(), costs.end());
    plot.series.push_back({.name = level.name, .x = {*least, *most}, .y = {level.error, level.error}});
  }
  return plot;
}

}  // namespace enc::bench
