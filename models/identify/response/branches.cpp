#include "models/identify/response/branches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "models/identify/response/loop_rows.h"
#include "models/order_statistics.h"

namespace enc::models {
namespace {

constexpr double kOfUsual = 0.25;     // of the usual travel: with less the probe is at standstill or turns
constexpr double kTurnNoise = 8.0;    // standard deviations: so near to the deepest reading both branches mix
constexpr double kSameGround = 0.01;  // of the depth: ground that lies farther out was covered before
constexpr int kLevels = 16;           // of depth, between which speed is measured

struct Branch {
  std::size_t from = 0, to = 0;  // of the press, `to` not included
  double sign = 1.0;             // of the travel

  // The k-th reading from the outside in.
  [[nodiscard]] std::size_t inwards(std::size_t k) const { return sign > 0.0 ? from + k : to - 1 - k; }
};

// Travel from one reading to the next, m: the middle one of those between levels of depth, which neither a
// hold nor a slow end rules.
double usual_step(std::span<const double> depth, const Branch& branch, double deepest) {
  std::vector<double> crossed, readings;
  int level = 1;
  for (std::size_t k = 0; k < branch.to - branch.from; ++k) {
    const double d = depth[branch.inwards(k)];
    for (; level < kLevels && d > deepest * level / kLevels; ++level) {
      if (k == 0) continue;
      const double before = depth[branch.inwards(k - 1)];
      crossed.push_back(static_cast<double>(k) - (d - deepest * level / kLevels) / (d - before));
    }
  }
  for (std::size_t k = 1; k < crossed.size(); ++k) readings.push_back(crossed[k] - crossed[k - 1]);
  const double usual = median(readings);
  return usual > 0.0 ? deepest / kLevels / usual : deepest;
}

struct Window {
  std::ptrdiff_t half = 1;  // readings
  double threshold = 0.0;   // m: with less travel over the window it is at standstill
  double step = 0.0;        // m, of the branch, from one reading to the next
};

// As long as noise demands, so that a hold is not taken for motion.
Window window_of(std::span<const double> depth, const Branch& branch, double deepest, double noise) {
  constexpr double kShare = 1.0 / 50.0;  // of a branch
  constexpr double kOver = 14.0;         // standard deviations of travel at usual speed: 5 of the threshold
  const double step = usual_step(depth, branch, deepest);
  const double moving = deepest / step;  // readings
  double half = std::clamp(moving * kShare, 1.0, 20.0);
  half = std::max(half, std::min(std::ceil(kOver * noise / step), moving / 8.0));
  Window window;
  window.half = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(half));
  window.threshold = kOfUsual * 2.0 * static_cast<double>(window.half) * step;
  window.step = step;
  return window;
}

// Runs of readings at standstill that outlast the window, and what the window reaches on either side of them.
std::vector<bool> holds_in(const std::vector<bool>& still, std::ptrdiff_t half) {
  std::vector<bool> held(still.size(), false);
  const auto n = static_cast<std::ptrdiff_t>(still.size());
  const auto is_still = [&](std::ptrdiff_t i) { return still[static_cast<std::size_t>(i)]; };
  for (std::ptrdiff_t from = 0, to = 0; from < n; from = to) {
    for (to = from; to < n && is_still(to) == is_still(from);) ++to;
    if (!is_still(from) || to - from <= 2 * half) continue;
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, from - half); i < std::min(n, to + half); ++i)
      held[static_cast<std::size_t>(i)] = true;
  }
  return held;
}

struct Motion {
  std::vector<bool> moves;  // along the branch
  std::vector<bool> held;
};
Motion motion_in(std::span<const double> depth, const Branch& branch, const Window& window) {
  const auto n = static_cast<std::ptrdiff_t>(depth.size());
  Motion motion{std::vector<bool>(depth.size()), {}};
  std::vector<bool> still(depth.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto before = static_cast<std::size_t>(std::max<std::ptrdiff_t>(i - window.half, 0));
    const auto after = static_cast<std::size_t>(std::min(i + window.half, n - 1));
    const double travel = branch.sign * (depth[after] - depth[before]);
    motion.moves[static_cast<std::size_t>(i)] = travel > window.threshold;
    still[static_cast<std::size_t>(i)] = std::abs(travel) <= window.threshold;
  }
  motion.held = holds_in(still, window.half);
  return motion;
}

// The readings at which the way turns by more than `least`, and the first and the last.
std::vector<std::size_t> turns_in(std::span<const double> depth, double least) {
  std::vector<std::size_t> turns{0};
  std::size_t low = 0, high = 0;
  int way = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] < depth[low]) low = i;
    if (depth[i] > depth[high]) high = i;
    if (way >= 0 && depth[i] < depth[high] - least) {
      turns.push_back(high);
      way = -1, low = i;
    } else if (way <= 0 && depth[i] > depth[low] + least) {
      turns.push_back(low);
      way = 1, high = i;
    }
  }
  turns.push_back(depth.size() - 1);
  return turns;
}

// A hand that holds a depth trembles about it: its strokes are too short for a press.
std::vector<bool> tremor_in(std::span<const double> depth, double least, double deepest) {
  // A stroke of a tremor is no longer than this, m, and than this share of the depth.
  constexpr double kLongest = 0.8e-3, kShare = 0.25;
  const double most = std::min(kLongest, kShare * deepest);
  std::vector<bool> trembles(depth.size(), false);
  const std::vector<std::size_t> turns = turns_in(depth, least);
  for (std::size_t k = 1; k < turns.size(); ++k) {
    // The first and the last stroke are of a press.
    const bool inner = k > 1 && k + 1 < turns.size();
    if (!inner || std::abs(depth[turns[k]] - depth[turns[k - 1]]) > most) continue;
    for (std::size_t i = turns[k - 1]; i <= turns[k]; ++i) trembles[i] = true;
  }
  return trembles;
}

// Leaves out readings over ground that the branch has covered before.
void leave_minor_loops(std::span<const double> depth, const Branch& branch, double margin,
                       const std::vector<bool>& trembles, std::vector<bool>& moves) {
  double covered = -INFINITY;
  for (std::size_t i = branch.from; i < branch.to; ++i) {
    if (trembles[i]) continue;
    const double along = branch.sign * depth[i];
    if (along < covered - margin) moves[i] = false;
    covered = std::max(covered, along);
  }
}

// The middle of a press, and the readings around it that belong to neither branch: first to last.
struct Turn {
  std::size_t at = 0, first = 0, last = 0;

  // A turn without a hold, at like speeds: the windows that span it show no travel, so the readings near
  // to it are left out already.
  [[nodiscard]] bool sharp(const Window& in, const Window& out, double margin) const {
    constexpr double kAlike = 1.25, kSpare = 2.0;
    const double readings = margin / in.step + margin / out.step;
    return std::max(in.step, out.step) <= kAlike * std::min(in.step, out.step) &&
           static_cast<double>(last - first) <= kAlike * readings + kSpare;
  }
};
Turn turn_of(const std::vector<double>& depth, double edge) {
  const auto at_top = [&](double d) { return d >= edge; };
  Turn turn;
  turn.first = static_cast<std::size_t>(std::find_if(depth.begin(), depth.end(), at_top) - depth.begin());
  turn.last = depth.size() - 1 -
              static_cast<std::size_t>(std::find_if(depth.rbegin(), depth.rend(), at_top) - depth.rbegin());
  turn.at = (turn.first + turn.last) / 2;
  return turn;
}

}  // namespace

std::vector<LoopPoint> split_branches(std::vector<LoopPoint>& press) {
  if (press.empty()) return {};
  std::vector<double> raw;
  raw.reserve(press.size());
  for (const LoopPoint& p : press) raw.push_back(p.deflection);
  const double noise = position_noise(raw), margin = kTurnNoise * noise;
  const std::vector<double> depth = without_spikes(std::move(raw));
  const double top = *std::max_element(depth.begin(), depth.end());
  const Turn turn = turn_of(depth, top - margin);
  const Branch in{0, turn.at + 1, 1.0}, out{turn.at, press.size(), -1.0};
  const Window window_in = window_of(depth, in, top, noise), window_out = window_of(depth, out, top, noise);
  const bool sharp = turn.sharp(window_in, window_out, margin);
  const double wobble = std::max(margin, kSameGround * top);
  const std::vector<bool> trembles = tremor_in(depth, wobble, top);
  std::vector<bool> kept(press.size(), false);
  for (const Branch& branch : {in, out}) {
    Motion motion = motion_in(depth, branch, branch.sign > 0.0 ? window_in : window_out);
    leave_minor_loops(depth, branch, wobble, trembles, motion.moves);
    for (std::size_t i = branch.from; i < branch.to; ++i) {
      press[i].held = motion.held[i] || trembles[i] || (!sharp && i >= turn.first && i <= turn.last);
      kept[i] = motion.moves[i] && !press[i].held;
    }
  }
  std::vector<LoopPoint> moving;
  for (std::size_t i = 0; i < press.size(); ++i) {
    press[i].pressing = i <= turn.at;
    if (kept[i]) moving.push_back(press[i]);
  }
  return moving;
}

}  // namespace enc::models
