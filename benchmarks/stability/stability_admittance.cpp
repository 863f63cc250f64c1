// A machine that measures force: the stiffness of what it renders over dead time, period and grip. Foretold
// by the large-signal loop of core/control/scene/steadiness.h, spot checks by the twin.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/stability/maps.h"
#include "benchmarks/stiffness/push_study.h"
#include "core/control/scene/scene.h"
#include "core/control/scene/steadiness.h"

namespace enc::bench::stability {
namespace {

using certificate::Rest;

struct Pushed {
  const char* name;
  double stiffness, damping;  // N/m, N s/m
};
constexpr std::array<Pushed, 3> kHands{
    {{"0.13 N/mm", 130.0, 2.0}, {"0.7 N/mm", 700.0, 4.0}, {"2 N/mm", 2000.0, 8.0}}};
constexpr std::array kTicks{0.1e-3, 1e-3, 10e-3};  // s
constexpr std::size_t kOwn = 1;                    // of these, that of the machine: the twin runs with it
constexpr double kPushDepth = 15e-3, kPushForce = 30.0,
                 kPushLimit = 23e-3;  // m, N, m: of the scene `stiffness`
constexpr double kAway = 20e-3;       // m, of the tip
constexpr std::size_t kEnough = 60;   // places: of fewer, one or two beside the boundary are more than 5 %

models::Setup pushed_setup(const BenchContext& context, const Pushed& hand, double period, double delay) {
  models::Setup setup =
      stiffness::push_setup(context.models, {},
                            {fmt::format("truth.pusher.stiffness_N_per_mm={}", hand.stiffness * 1e-3),
                             fmt::format("truth.pusher.damping_Ns_per_m={}", hand.damping),
                             fmt::format("rig.contact.hand_stiffness_N_per_mm={}", hand.stiffness * 1e-3),
                             fmt::format("rig.contact.hand_damping_Ns_per_m={}", hand.damping)});
  setup.rig.loop.rate = 1.0 / period;
  setup.rig.manipulator.delay = delay;
  setup.twin.hexapod.delay_cycles = std::llround(delay / period);
  return setup;
}

Rest by_swing(double swing, double still) {
  return !(swing <= kAway) ? Rest::away : swing > still ? Rest::cycle : Rest::still;
}

Rest foretold(const models::Setup& setup, double stiffness) {
  const Steadiness loop(setup.rig);
  const Response spring({{stiffness, 0, 0, 0}, {stiffness, 0, 0, 0}, kPushLimit}, 0.0);
  const double most = std::min(kPushDepth, kPushForce / stiffness);
  return by_swing(loop.swing(spring, most, kPushLimit, Steadiness::kSlow), loop.still());
}

// The twin as the scene pushes it.
Rest pushed(const models::Setup& setup, double stiffness, std::uint64_t seed) {
  const Steadiness loop(setup.rig);
  const auto push = stiffness::push_once(stiffness::with_stiffness(setup, stiffness), seed);
  return by_swing(push.peak_to_peak, loop.still());
}

void add_spots(Bench& bench, const std::vector<std::string>& titles) {
  const BenchContext& context = bench.context;
  std::vector<Place> places = random_places(context, kHands.size(),
                                            context.full    ? 400
                                            : context.quick ? 16
                                                            : 120,
                                            3);
  // The twin's dead time is whole cycles, and at least one.
  std::erase_if(places, [](const Place& at) { return kDelays[at.delay] < kTicks[kOwn]; });
  struct Spot {
    double stiffness;
    Rest told, seen;
  };
  const auto found = bench.each(places, [&](const Place& at) {
    const models::Setup setup = pushed_setup(context, kHands[at.panel], kTicks[kOwn], kDelays[at.delay]);
    const double stiffness = about(lowest_stable_stiffness(loop_of(setup.rig)), at.share);
    return Spot{stiffness, foretold(setup, stiffness), pushed(setup, stiffness, context.seed)};
  });
  Table table{"map_admittance_spots",
              "Spot checks of the admittance's map",
              {"panel", "dead time (ms)", "K (N/m)", "foretold", "twin"}};
  double same = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [stiffness, told, seen] = found[i];
    same += (told == Rest::still) == (seen == Rest::still) ? 1.0 : 0.0;
    table.add(titles[places[i].panel * kTicks.size() + kOwn], kDelays[places[i].delay] * 1e3,
              fmt::format("{:.3g}", stiffness), words_of(told), words_of(seen));
  }
  bench.figure("admittance.agree", 100.0 * same / static_cast<double>(places.size()), "%",
               places.size() < kEnough ? Bounds{} : at_least(95.0),
               fmt::format("of {} random places of the admittance's map: stands still in the twin, as "
                           "foretold",
                           places.size()));
  bench.table(std::move(table));
}

}  // namespace

void add_admittance_map(Bench& bench) {
  struct Cell {
    std::size_t panel, delay;
    double stiffness;
  };
  std::vector<std::string> titles;
  std::vector<Cell> all;
  for (const Pushed& hand : kHands)
    for (const double period : kTicks) {
      for (std::size_t delay = 0; delay < kDelays.size(); ++delay)
        for (const double stiffness : stiffnesses(bench.context))
          all.push_back({titles.size(), delay, stiffness});
      titles.push_back(fmt::format("hand {}, every {:g} ms", hand.name, period * 1e3));
    }
  const auto setup = [&](const Cell& c) {
    return pushed_setup(bench.context, kHands[c.panel / kTicks.size()], kTicks[c.panel % kTicks.size()],
                        kDelays[c.delay]);
  };
  const auto found = bench.each(all, [&](const Cell& c) { return foretold(setup(c), c.stiffness); });
  Map map("map_admittance", "What the hexapod renders by measuring force, pushed 15 mm deep or with 30 N",
          titles, kTicks.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    map.cell(all[i].panel, all[i].delay, all[i].stiffness, found[i]);
    if (all[i].stiffness != kSoftest) continue;
    const models::Setup at = setup(all[i]);
    map.line("linear: 1 + Z G H e^-(s t_d)/K", all[i].panel, all[i].delay,
             lowest_stable_stiffness(loop_of(at.rig)));
    if (bench.context.full)  // some seconds for each panel
      map.line("softest that `check` names", all[i].panel, all[i].delay,
               Steadiness(at.rig).softest(kPushDepth, kPushForce, Steadiness::kSlow));
  }
  map.add_to(bench,
             "Here soft is what is hard: below the line it swings. The limits of speed and acceleration have "
             "it swing on above the line, too. Of the hand the grip is meant, as stiff as it is at the "
             "loop's own frequency.");
  add_spots(bench, titles);
}

}  // namespace enc::bench::stability
