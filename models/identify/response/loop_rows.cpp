#include "models/identify/response/loop_rows.h"

#include <algorithm>
#include <cmath>

#include "models/order_statistics.h"

namespace enc::models {
namespace {

// Rows of one number, others between them only where they have none.
std::vector<PressRows> marked(std::span<const LoopRow> rows) {
  std::vector<PressRows> presses;
  std::int64_t repeat = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].repeat == 0) continue;
    if (rows[i].repeat != repeat) presses.push_back({i, i, i, i, i});
    presses.back().last = i;
    repeat = rows[i].repeat;
  }
  return presses;
}

struct Extent {
  double low = INFINITY, high = -INFINITY;
  void take(double x) { low = std::min(low, x), high = std::max(high, x); }
  [[nodiscard]] double at(double share) const { return low + share * (high - low); }
};

// Cuts a press where it was released in between: at the deflection that lies farthest out there.
void add_pieces(std::span<const LoopRow> rows, const PressRows& press, std::vector<PressRows>& pieces) {
  constexpr double kReleased = 0.05, kPressed = 0.5;  // of the force
  constexpr int kFew = 3;                             // readings: fewer are noise
  Extent force, depth;
  for (std::size_t i = press.first; i <= press.last; ++i) {
    if (!std::isnan(rows[i].force)) force.take(rows[i].force);
    depth.take(rows[i].deflection);
  }
  PressRows piece{press.first, press.first, press.first, press.first, press.first};
  bool pressed = false;
  int low = 0;
  std::size_t out = press.first;
  for (std::size_t i = press.first; i <= press.last; ++i) {
    piece.last = i;
    const double f = rows[i].force;
    if (pressed && f < force.at(kReleased)) {
      if (low == 0 || rows[i].deflection < rows[out].deflection) out = i;
      ++low;
    }
    if (!(f > force.at(kPressed))) continue;
    if (low >= kFew && rows[out].deflection < depth.at(0.5)) {
      piece.last = out;
      pieces.push_back(piece);
      piece = {out + 1, i, i, i, i};
    }
    pressed = true;
    low = 0;
  }
  pieces.push_back(piece);
}

// How far the rows belong to the way in or out: until the motion turns, seen from the deepest reading.
std::size_t way_end(const std::vector<double>& positions, std::size_t deepest, std::size_t stop,
                    double depth) {
  constexpr double kTurns = 0.2;  // of the depth
  const bool back = stop < deepest;
  std::size_t end = deepest;
  for (std::size_t i = deepest; i != stop; back ? --i : ++i) {
    const std::size_t next = back ? i - 1 : i + 1;
    if (positions[next] > positions[end] + kTurns * depth) break;
    if (positions[next] <= positions[end]) end = next;
  }
  return end;
}

}  // namespace

std::vector<double> without_spikes(std::vector<double> values) {
  double before = values.empty() ? 0.0 : values.front();
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double own = values[i], after = values[i + 1];
    values[i] = std::clamp(own, std::min(before, after), std::max(before, after));
    before = own;
  }
  return values;
}

double position_noise(std::span<const double> positions) {
  constexpr double kShare = 0.9, kQuantile = 1.6449;  // of a normal number's size
  std::vector<double> second;
  for (std::size_t i = 2; i < positions.size(); ++i)
    second.push_back(std::abs(positions[i] - 2.0 * positions[i - 1] + positions[i - 2]));
  return second.empty() ? 0.0 : percentile(std::move(second), kShare) / (kQuantile * std::sqrt(6.0));
}

std::vector<PressRows> presses_in(std::span<const LoopRow> rows) {
  std::vector<PressRows> presses;
  for (const PressRows& press : marked(rows)) add_pieces(rows, press, presses);
  std::vector<double> positions;
  positions.reserve(rows.size());
  for (const LoopRow& row : rows) positions.push_back(row.deflection);
  positions = without_spikes(std::move(positions));
  for (PressRows& press : presses) {
    const auto at = [&](std::size_t i) { return positions.begin() + static_cast<std::ptrdiff_t>(i); };
    press.deepest =
        static_cast<std::size_t>(std::max_element(at(press.first), at(press.last + 1)) - positions.begin());
  }
  for (std::size_t k = 0; k < presses.size(); ++k) {
    PressRows& press = presses[k];
    Extent depth;
    for (std::size_t i = press.first; i <= press.last; ++i) depth.take(positions[i]);
    press.from =
        way_end(positions, press.deepest, k > 0 ? presses[k - 1].deepest : 0, depth.at(1.0) - depth.low);
    press.to =
        way_end(positions, press.deepest, k + 1 < presses.size() ? presses[k + 1].deepest : rows.size() - 1,
                depth.at(1.0) - depth.low);
  }
  return presses;
}

}  // namespace enc::models
