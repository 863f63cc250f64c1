// A button that is pressed to its bottom, in MuJoCo, over stiffness, delay, period and grip: its force falls
// at the trigger, so what is unstable hops between its branches.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "benchmarks/stability/maps.h"

namespace enc::bench::stability {
namespace {

using certificate::Rest;

constexpr double kTrigger = 2e-3, kFall = 0.5e-3, kBottom = 4e-3, kBelow = 2e-3;  // m, deep
constexpr double kKeyAside = 1e-3;                                                // m, beside where it rests
constexpr double kKeyStep = 1e-3;                                                 // s, RK4

// N: resistance up to the trigger, half of it behind, a floor [VisHap Fig 4]; `floor`, N/m, is the stiffest.
double key_pushes(double depth, double floor) {
  const double resist = floor * 2.0 / 3.0, after = floor / 3.0;
  if (depth <= 0.0) return 0.0;
  if (depth < kTrigger) return resist * depth;
  const double fallen = std::min(1.0, (depth - kTrigger) / kFall);
  const double soft = (1.0 - fallen) * resist * kTrigger + fallen * after * depth;
  return depth < kBottom ? soft : after * kBottom + floor * (depth - kBottom);
}

struct KeyCell {
  std::size_t panel, delay;
  double stiffness;
  Device device;
};

// A finger key_pushes with what holds it 2 mm below the bottom: that is x = 0.
Rest key_outcome(const KeyCell& cell) {
  const int steps = static_cast<int>(std::lround(cell.device.period / kKeyStep));
  Slide slide(cell.device, {}, {Scheme::rk4, steps}, kKeyAside);
  const double hand = key_pushes(kBottom + kBelow, cell.stiffness);
  const double swing = 6.3 * std::sqrt((cell.device.mass + cell.device.hand_mass) /
                                       (cell.stiffness + cell.device.hand_spring));
  const double seconds = std::clamp(60.0 * swing, 2.0 + 40.0 * cell.device.delay, 16.0);
  const auto quarter = static_cast<std::size_t>(seconds / cell.device.period / 4.0);
  double before = 0.0, last = 0.0;
  for (int part = 0; part < 4; ++part) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < quarter; ++i) {
      slide.period(key_pushes(kBottom + kBelow - slide.x(), cell.stiffness) - hand);
      low = std::min(low, slide.x());
      high = std::max(high, slide.x());
      if (std::abs(slide.x()) > 20.0 * kKeyAside) return Rest::away;
    }
    before = last;
    last = high - low;
  }
  return last < 0.01 * kKeyAside || last < 0.9 * before ? Rest::still : Rest::cycle;
}

}  // namespace

void add_button_map(Bench& bench) {
  std::vector<std::string> titles;
  std::vector<Device> devices;
  for (const double period : {1e-3, 10e-3})
    for (const Grip& grip : kGrips) {
      titles.push_back(fmt::format("{}, every {:g} ms", grip.name, period * 1e3));
      devices.push_back(held_by({0.1, 0.2, period, 0.0}, grip));
    }
  std::vector<KeyCell> all;
  for (std::size_t panel = 0; panel < devices.size(); ++panel)
    for (std::size_t delay = 0; delay < kDelays.size(); ++delay) {
      if (std::abs(std::remainder(kDelays[delay], kKeyStep)) > 1e-9) continue;  // no whole number of steps
      for (const double stiffness : stiffnesses(bench.context)) {
        all.push_back({panel, delay, stiffness, devices[panel]});
        all.back().device.delay = kDelays[delay];
      }
    }
  const auto found = bench.each(all, key_outcome);
  Map map("map_button", "A button that is pressed to its bottom and moved 1 mm aside", titles, 3);
  double same = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const KeyCell& cell = all[i];
    const certificate::SampledLoop loop = loop_of(cell.device);
    map.cell(cell.panel, cell.delay, cell.stiffness, found[i]);
    const double exact = certificate::critical_stiffness(loop);
    same += (cell.stiffness <= exact) == (found[i] == Rest::still) ? 1.0 : 0.0;
    if (cell.stiffness != kSoftest) continue;
    map.line("eigenvalues, its floor", cell.panel, cell.delay, exact);
    map.line("passive (Colgate, Schenkel)", cell.panel, cell.delay,
             certificate::passive_stiffness(loop.alone(), {}));
    map.line("b/(T/2 + delay) (Gil, Hulin)", cell.panel, cell.delay,
             certificate::delayed_stiffness(loop.alone(), {}));
  }
  map.add_to(
      bench,
      "All by MuJoCo: no friction, no counts. 2/3 of the stiffness up to 2 mm, 1/3 behind, all of it from "
      "4 mm on: what its floor makes unstable is caught by the softer branches, or by the air above it, "
      "and goes on as a limit cycle.");
  bench.figure("button.agree", 100.0 * same / static_cast<double>(all.size()), "%", at_least(95.0),
               fmt::format("of {} places of the button's map: rests in MuJoCo if the eigenvalues of its "
                           "floor say so",
                           all.size()));
}

}  // namespace enc::bench::stability
