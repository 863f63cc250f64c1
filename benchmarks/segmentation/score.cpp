#include "benchmarks/segmentation/score.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace enc::bench::segmentation {
namespace {

Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  if (values.empty()) return {};
  Mean mean{.value = 0.0, .half = kUnset};
  for (const double x : values) mean.value += x / n;
  if (values.size() < 2) return mean;
  double square = 0.0;
  for (const double x : values) square += (x - mean.value) * (x - mean.value);
  mean.half = models::student(n - 1.0) * std::sqrt(square / (n - 1.0) / n);
  return mean;
}

std::string words(const Mean& mean) {
  if (std::isnan(mean.half)) return fmt::format("{:.2f}", 1e2 * mean.value);
  return fmt::format("{:.2f} ({})", 1e2 * mean.value, interval_text(mean));
}

}  // namespace

Value ends(const Mean& share) {
  if (std::isnan(share.half)) return {share.value};
  return {share.value, std::max(0.0, share.value - share.half), std::min(1.0, share.value + share.half)};
}

std::string interval_text(const Mean& share, int digits) {
  if (std::isnan(share.half)) return "not known";
  const Value percent = in_percent(share);
  return fmt::format("{:.{}f}..{:.{}f}", percent.least, digits, percent.most, digits);
}

Score score(std::span<const Judged> pairs, Method method, const Filter& of) {
  std::vector<double> correct, positives, negatives, iou;
  for (const Judged& pair : pairs) {
    const auto& found = pair.by[method];
    if (!found || (of && !of(pair))) continue;
    correct.push_back(found->correct());
    positives.push_back(found->false_positives());
    negatives.push_back(found->false_negatives());
    iou.push_back(found->iou());
  }
  return {correct.size(), mean_of(correct), mean_of(positives), mean_of(negatives), mean_of(iou)};
}

double apart(const Mean& a, const Mean& b) {
  return std::abs(a.value - b.value) / std::sqrt(a.half * a.half + b.half * b.half);
}

void add_rows(Table& table, const std::string& row, std::span<const Judged> pairs, const Filter& of) {
  for (std::size_t i = 0; i < kMethods.size(); ++i) {
    const Score s = score(pairs, static_cast<Method>(i), of);
    if (s.pairs > 0)
      table.add(row, kMethods[i], s.pairs, words(s.correct), words(s.false_positives),
                words(s.false_negatives), words(s.iou));
  }
}

}  // namespace enc::bench::segmentation
