#include "trial/sweep/statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "models/order_statistics.h"
#include "models/student.h"
#include "models/tables/number_text.h"

namespace enc::trial {
namespace {

constexpr std::size_t kParts = 8;  // levels of a range

// Relative to the first value: the mean of equal values is that value, to the last bit.
double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double x : values) sum += x - values[0];
  return values[0] + sum / static_cast<double>(values.size());
}
double squares(const std::vector<double>& values, double mean) {
  double sum = 0.0;
  for (const double x : values) sum += (x - mean) * (x - mean);
  return sum;
}

// Indices of the runs of each level.
struct Level {
  std::string name;
  double x = kUnset;
  std::vector<std::size_t> runs;
};

std::vector<Level> levels_by_value(const std::vector<std::string>& parameter) {
  std::map<std::string, std::vector<std::size_t>> by_value;
  for (std::size_t i = 0; i < parameter.size(); ++i) by_value[parameter[i]].push_back(i);
  std::vector<Level> levels;
  levels.reserve(by_value.size());
  for (auto& [value, runs] : by_value) levels.push_back({value, number_of(value), std::move(runs)});
  if (std::none_of(levels.begin(), levels.end(), [](const Level& one) { return std::isnan(one.x); }))
    std::sort(levels.begin(), levels.end(), [](const Level& a, const Level& b) { return a.x < b.x; });
  return levels;
}

std::vector<Level> levels_by_rank(const std::vector<std::string>& parameter) {
  std::vector<double> x(parameter.size());
  std::transform(parameter.begin(), parameter.end(), x.begin(), number_of);
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  std::vector<Level> levels(kParts);
  for (std::size_t i = 0; i < order.size(); ++i) levels[i * kParts / order.size()].runs.push_back(order[i]);
  for (Level& level : levels) {
    double sum = 0.0;
    for (const std::size_t i : level.runs) sum += x[i];
    level.x = sum / static_cast<double>(level.runs.size());
    level.name = fmt::format("{:.4g} to {:.4g}", x[level.runs.front()], x[level.runs.back()]);
  }
  return levels;
}

std::size_t different(std::vector<std::string> values) {
  std::sort(values.begin(), values.end());
  return static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

}  // namespace

double number_of(const std::string& text) { return models::number_in<double>(text).value_or(kUnset); }

Summary summary_of(const std::vector<double>& values) {
  std::vector<double> known;
  std::copy_if(values.begin(), values.end(), std::back_inserter(known),
               [](double x) { return std::isfinite(x); });
  Summary s;
  s.n = known.size();
  if (s.n == 0) return s;
  const auto n = static_cast<double>(s.n);
  s.mean = mean_of(known);
  s.least = models::percentile(known, 0.0);
  s.most = models::percentile(known, 1.0);
  s.p5 = models::known_percentile(known, 0.05);
  s.median = models::known_percentile(known, 0.5);
  s.p95 = models::known_percentile(known, 0.95);
  if (s.n >= 2) s.sd = std::sqrt(squares(known, s.mean) / (n - 1.0));
  if (s.n >= 3) s.half = models::student(n - 1.0) * s.sd / std::sqrt(n);
  return s;
}

Effect effect_of(const std::vector<std::string>& parameter, const std::vector<double>& values,
                 std::size_t most) {
  const bool numbers = std::all_of(parameter.begin(), parameter.end(),
                                   [](const auto& p) { return !std::isnan(number_of(p)); });
  const bool many = different(parameter) > most && numbers;
  Effect effect;
  std::vector<double> all;
  double within = 0.0;
  for (const Level& level : many ? levels_by_rank(parameter) : levels_by_value(parameter)) {
    std::vector<double> its;
    for (const std::size_t i : level.runs)
      if (std::isfinite(values[i])) its.push_back(values[i]);
    effect.levels.push_back({level.name, level.x, summary_of(its)});
    if (!its.empty()) within += squares(its, mean_of(its));
    all.insert(all.end(), its.begin(), its.end());
  }
  const double total = all.empty() ? 0.0 : squares(all, mean_of(all));
  if (total > 0.0) effect.share = std::max(0.0, 1.0 - within / total);
  return effect;
}

}  // namespace enc::trial
