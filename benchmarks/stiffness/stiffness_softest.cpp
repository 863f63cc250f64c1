// How soft an object this machine holds still: what `check` says beforehand (core/control/scene/steadiness.h)
// against the twin, over hands, filters and machines.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/stiffness/stiffness.h"
#include "core/control/scene/steadiness.h"

namespace enc::bench::stiffness {
namespace {

constexpr double kDepth = 0.015, kForce = 30.0;  // m, N: what `check` prints is for this push
constexpr double kWithin = 1.25;

struct Hand {
  double stiffness, damping;  // N/m, N s/m
};
struct Cell {
  Hand hand;
  double filter, servo;              // Hz
  bool limited;                      // in its acceleration
  double ramp;                       // s
  double said = kUnset;              // N/m
  bool least = false;                // what is softer is not felt, so nothing is said of it
  double there = 0.0, softer = 0.0;  // m, peak to peak, most: at what was said, and 25 % softer
  double still = kUnset;             // m
};

std::vector<Cell> cells_of(const BenchContext& context) {
  constexpr std::array<Hand, 5> kHands{{{40, 1}, {200, 2}, {700, 4}, {2000, 8}, {5000, 15}}};
  std::vector<Cell> cells;
  for (const double ramp : {Steadiness::kSlow, Steadiness::kQuick})
    for (const bool limited : {true, false})
      for (const Hand& hand : kHands)
        for (const double filter : {2.0, 5.0, 30.0})
          for (const double servo : {15.0, 60.0}) cells.push_back({hand, filter, servo, limited, ramp});
  if (context.quick) cells = {cells[12], cells[42], cells[72]};
  return cells;
}

models::Setup setup_of(const BenchContext& context, const Cell& cell) {
  const double k = cell.hand.stiffness * 1e-3, b = cell.hand.damping;
  std::vector<std::string> set{fmt::format("truth.pusher.stiffness_N_per_mm={}", k),
                               fmt::format("truth.pusher.damping_Ns_per_m={}", b),
                               fmt::format("rig.contact.hand_stiffness_N_per_mm={}", k),
                               fmt::format("rig.contact.hand_damping_Ns_per_m={}", b),
                               fmt::format("rig.force.filter_hz={}", cell.filter),
                               fmt::format("truth.hexapod.servo_hz={}", cell.servo),
                               fmt::format("rig.manipulator.servo_hz={}", cell.servo),
                               fmt::format("pusher.ramp_s={}", cell.ramp)};
  if (!cell.limited) set.insert(set.end(), unlimited_acceleration().begin(), unlimited_acceleration().end());
  return push_setup(context.models, set);
}

// The widest swing over pushes of several depths, none of which check asks for but the deepest.
double widest(const BenchContext& context, models::Setup setup) {
  double way = 0.0;
  std::uint64_t seed = context.seed;
  for (const double share : {1.0, 0.85, 0.6, 0.38}) {
    setup.scene.pusher->depth = share * kDepth;
    setup.scene.pusher->force = share * kForce;
    const double here = push_once(setup, seed++).peak_to_peak;
    way = std::isnan(here) ? here : std::max(way, here);
  }
  return way;
}

void judge(const BenchContext& context, Cell& cell) {
  const models::Setup setup = setup_of(context, cell);
  const Steadiness loop(setup.rig);
  cell.still = loop.still();
  cell.said = loop.softest(kDepth, kForce, cell.ramp);
  cell.least = cell.said < kWithin * loop.least_felt(kDepth);
  cell.there = widest(context, with_stiffness(setup, cell.said));
  cell.softer = widest(context, with_stiffness(setup, cell.said / kWithin));
}

}  // namespace

void add_softest(const BenchContext& context, BenchResult& result) {
  std::vector<Cell> cells = cells_of(context);
  in_parallel(cells.size(), [&](std::size_t i) { judge(context, cells[i]); });
  Table table{"stiffness_softest",
              "The softest spring that stands still, as `check` says it, and the twin",
              {"hand (N/m)", "its damping (N s/m)", "filter (Hz)", "servo (Hz)", "acceleration limited",
               "ramp (s)", "said (N/m)", "the twin there (mm)", "25 % softer (mm)", "still (mm)"}};
  double moving = 0.0, careful = 0.0;
  for (const Cell& cell : cells) {
    moving += cell.there <= cell.still ? 0.0 : 1.0;
    careful += cell.least || cell.softer > cell.still ? 0.0 : 1.0;
    table.rows.push_back({fmt::format("{:g}", cell.hand.stiffness), fmt::format("{:g}", cell.hand.damping),
                          fmt::format("{:g}", cell.filter), fmt::format("{:g}", cell.servo),
                          cell.limited ? "yes" : "no", fmt::format("{:g}", cell.ramp),
                          fmt::format("{:.1f}", cell.said), fmt::format("{:.3f}", 1e3 * cell.there),
                          fmt::format("{:.3f}", 1e3 * cell.softer), fmt::format("{:.3f}", 1e3 * cell.still)});
  }
  table.note =
      "The way of the true tip in the second half of a hold, peak to peak: the most of four pushes, 15, "
      "12.8, 9 "
      "and 5.7 mm deep.";
  result.tables.push_back(std::move(table));
  const auto count = static_cast<double>(cells.size());
  result.figures.push_back({"stiffness.softest.cells", kUnset, count, "", Role::ours, kUnset, kUnset,
                            "hands of 40 to 5000 N/m that push in 2 s and in 0.5 s, filters of 2 to 30 Hz, "
                            "servos of 15 and 60 Hz, with the "
                            "limit of acceleration and without"});
  result.figures.push_back({"stiffness.softest.moving", kUnset, moving, "", Role::ours, kUnset, 0.0,
                            "of them, in which the twin does not hold still what check says it does"});
  result.figures.push_back({"stiffness.softest.careful", kUnset, careful, "", Role::ours, kUnset, kUnset,
                            "of them, in which the twin holds still what is 25 % softer, too"});
}

}  // namespace enc::bench::stiffness
