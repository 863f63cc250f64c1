#include "models/identify/response/onset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace enc::models {
namespace {

constexpr std::size_t kBins = 300;  // of deflection, in a window

// Means of readings of like deflection.
struct Bin {
  double weight = 0.0, deflection = 0.0, force = 0.0;
};
using Bins = std::vector<Bin>;

double mean_of(const std::vector<double>& x, std::size_t from, std::size_t to) {
  const auto at = [&](std::size_t i) { return x.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::accumulate(at(from), at(to), 0.0) / static_cast<double>(to - from);
}

// Readings of an approach: those before contact, and in contact up to this share of the force.
std::pair<std::size_t, std::size_t> window_of(const Approach& a, double share) {
  const std::size_t n = a.force.size(), few = std::max<std::size_t>(1, n / 400);
  const double zero = mean_of(a.force, 0, std::max<std::size_t>(few, std::min<std::size_t>(n, 5)));
  const double top = mean_of(a.force, n - few, n);
  std::size_t to = n;
  while (to > few && std::abs(mean_of(a.force, to - few, to) - zero) > share * std::abs(top - zero))
    to -= few;
  // As far out as it is to the deepest reading: more only makes the bins coarse.
  const double end = a.deflection[to - 1];
  const double span = *std::max_element(a.deflection.begin(), a.deflection.end()) - end;
  std::size_t from = to;
  while (from > 0 && a.deflection[from - 1] >= end - span) --from;
  return {from, to};
}

Bins bins_of(const Approach& a, double share) {
  const auto [from, to] = window_of(a, share);
  if (to - from < 5) return {};
  const auto at = [&](std::size_t i) { return a.deflection.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto [low, high] = std::minmax_element(at(from), at(to));
  if (!(*high > *low) || !std::isfinite(*high - *low)) return {};
  const std::size_t count = std::min(kBins, to - from);
  Bins bins(count);
  for (std::size_t i = from; i < to; ++i) {
    const double place = (a.deflection[i] - *low) / (*high - *low) * static_cast<double>(count);
    Bin& bin = bins[std::min(count - 1, static_cast<std::size_t>(place))];
    bin.weight += 1.0;
    bin.deflection += a.deflection[i];
    bin.force += a.force[i];
  }
  std::erase_if(bins, [](const Bin& bin) { return bin.weight == 0.0; });
  for (Bin& bin : bins) bin.deflection /= bin.weight, bin.force /= bin.weight;
  return bins;
}

// Sum of the squares that are left over if contact begins there, N^2.
double left_over(std::span<const Bins> all, double onset) {
  Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double squares = 0.0;
  for (const Bins& bins : all) {
    double weight = 0.0, force = 0.0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    const auto powers = [&](const Bin& bin) {
      const double in = std::max(0.0, bin.deflection - onset);
      return Eigen::Vector2d(in, in * in);
    };
    for (const Bin& bin : bins) {
      weight += bin.weight;
      mean += bin.weight * powers(bin);
      force += bin.weight * bin.force;
    }
    mean /= weight, force /= weight;
    for (const Bin& bin : bins) {
      const Eigen::Vector2d x = powers(bin) - mean;
      gram += bin.weight * x * x.transpose();
      right += bin.weight * (bin.force - force) * x;
      squares += bin.weight * (bin.force - force) * (bin.force - force);
    }
  }
  return std::max(0.0, squares - right.dot(gram.ldlt().solve(right)));
}

struct Candidate {
  double at = kUnset, error = kUnset;  // m
  double reach = kUnset;               // m, from there to the deepest reading of the window
};

// The least of the sums, first on a coarse grid and then on two fine ones; its curvature gives the error.
Candidate candidate_of(std::span<const Approach> approaches, double share) {
  std::vector<Bins> all;
  double low = INFINITY, high = -INFINITY, count = 0.0;
  for (const Approach& a : approaches) {
    Bins bins = bins_of(a, share);
    if (bins.empty()) continue;
    low = std::min(low, bins.front().deflection), high = std::max(high, bins.back().deflection);
    count += static_cast<double>(bins.size());
    all.push_back(std::move(bins));
  }
  if (all.empty() || !(high > low)) return {};
  constexpr int kSteps = 100;
  double from = low + 0.02 * (high - low), to = high - 0.05 * (high - low), step = 0.0, least = INFINITY,
         best = kUnset;
  for (int zoom = 0; zoom < 3; ++zoom) {
    step = (to - from) / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
      const double here = from + i * step, sum = left_over(all, here);
      if (sum < least) least = sum, best = here;
    }
    if (zoom == 0 && (best <= low + 0.03 * (high - low))) return {};  // it begins in contact
    from = best - 2.0 * step, to = best + 2.0 * step;
  }
  const double variance = least / std::max(1.0, count - static_cast<double>(all.size()) - 3.0);
  const double wide = 1e-3 * (high - low);  // over some bins: a sum of bins has kinks
  const double bend =
      (left_over(all, best - wide) + left_over(all, best + wide) - 2.0 * least) / (wide * wide);
  return {best, bend > 0.0 ? std::sqrt(2.0 * variance / bend) : variance > 0.0 ? kUnset : 0.0, high - best};
}

}  // namespace

Onset find_onset(std::span<const Approach> approaches) {
  constexpr std::array<double, 3> kShares{0.30, 0.15, 0.07};
  constexpr double kAgree = 2.5;         // standard deviations
  constexpr double kLeastBefore = 0.04;  // of the depth: so much has to lie before contact
  constexpr double kChance = 0.5;        // of the windows' range, where they differ by chance alone
  constexpr double kUnsure = 0.01;       // of the depth, of a curve that one window alone shows
  // Of the smallest window, where the curve begins softly. The nominal ball (felt, friction) is found 0.30 mm
  // too late at 20 mm/s, 0.45 of that window: 1.8 standard deviations of this error.
  constexpr double kSoft = 0.25;
  std::array<Candidate, kShares.size()> found;
  for (std::size_t i = 0; i < kShares.size(); ++i) found[i] = candidate_of(approaches, kShares[i]);
  const auto apart = [&](std::size_t i, std::size_t j) { return std::abs(found[i].at - found[j].at); };
  const auto agree = [&](std::size_t i, std::size_t j) {
    return apart(i, j) <= kAgree * std::hypot(found[i].error, found[j].error) + 1e-6;
  };
  double outermost = INFINITY, deepest = -INFINITY;
  for (const Approach& a : approaches)
    for (const double d : a.deflection) outermost = std::min(outermost, d), deepest = std::max(deepest, d);
  const auto known = [&](std::size_t i) { return !std::isnan(found[i].at) && !std::isnan(found[i].error); };
  Onset onset;
  double low = INFINITY, high = -INFINITY;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (known(i)) low = std::min(low, found[i].at), high = std::max(high, found[i].at);
  if (agree(0, 1) && agree(0, 2))
    onset = {found[0].at, std::hypot(found[0].error, kChance * (high - low))};
  else if (known(1) && known(2)) {
    // Each smaller window begins earlier: what a still smaller one would find is open.
    const bool soft = known(0) && found[0].at > found[1].at && found[1].at > found[2].at;
    onset = {found[2].at,
             std::hypot(found[2].error, std::max(high - low, soft ? kSoft * found[2].reach : 0.0))};
  } else if (const std::size_t i = known(1) ? 1 : 0; known(i))  // too few readings for a smaller window
    onset = {found[i].at, std::hypot(found[i].error, kUnsure * (deepest - found[i].at))};
  if (!onset.known()) return {};
  return onset.at - outermost >= kLeastBefore * (deepest - onset.at) ? onset : Onset{};
}

}  // namespace enc::models
