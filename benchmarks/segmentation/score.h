// What a set of pairs says about a method: means over pairs with their 95 % intervals.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "benchmarks/kit/kit.h"
#include "benchmarks/segmentation/pairs.h"
#include "models/identify/block_error.h"

namespace enc::bench::segmentation {

using Mean = models::Interval;  // 95 %, by Student's t over the pairs
// With the interval's ends; a share is nowhere below 0 or above 1, whatever t says of few pairs.
[[nodiscard]] Value ends(const Mean& share);
[[nodiscard]] inline Value in_percent(const Mean& share) { return ends(share) * 1e2; }
[[nodiscard]] std::string interval_text(const Mean& share, int digits = 2);  // in percent: "99.8..100.0"
// Of the pairs that a method saw.
struct Score {
  std::size_t pairs = 0;
  Mean correct, false_positives, false_negatives, iou;  // shares
};
using Filter = std::function<bool(const Judged&)>;
[[nodiscard]] Score score(std::span<const Judged> pairs, Method method, const Filter& of = nullptr);

// How far the means of two sets are apart, as a share of the 95 % interval of their difference.
[[nodiscard]] double apart(const Mean& a, const Mean& b);

// A line for each method that was there.
void add_rows(Table& table, const std::string& row, std::span<const Judged> pairs,
              const Filter& of = nullptr);

}  // namespace enc::bench::segmentation
