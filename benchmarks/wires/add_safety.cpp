// The safety matrix over seeds: the table of docs/reference/safety.md.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/wires/parts.h"
#include "benchmarks/wires/safety.h"

namespace enc::bench::wires {
namespace {

struct Case {
  const Fault* fault;
  Mode mode;
  std::uint64_t seed;
};

const char* words(End end) {
  switch (end) {
    case End::unharmed:
      return "none";
    case End::holds:
      return "goes on when cured";
    case End::link_lost:
      return "lost";
  }
  return "";
}

std::string range(double least, double most, const char* form) {
  return fmt::format("{} to {}", fmt::format(fmt::runtime(form), least),
                     fmt::format(fmt::runtime(form), most));
}

// Over the seeds of one mode, or of all.
struct Extremes {
  double least = kNever, most = 0.0;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

}  // namespace

void add_safety(Bench& bench) {
  const ShortPress press(bench.context.models);
  const models::Setup& setup = press.datagrams;
  const std::vector<std::uint64_t> seeds = bench.seeds(bench.context.count(5, 1));
  std::vector<Case> cases;
  // Those first in which nothing happens: how far it goes. Each fault has the same modes and seeds again.
  for (const Mode mode : kInjectedIn)
    for (const std::uint64_t seed : seeds) cases.push_back({&no_fault(), mode, seed});
  const std::size_t free = cases.size();
  for (const Fault& fault : faults())
    for (const Mode mode : kInjectedIn)
      for (const std::uint64_t seed : seeds) cases.push_back({&fault, mode, seed});
  const std::vector<Reaction> all = bench.each(
      cases, [&](const Case& one) { return react(press.of(*one.fault), *one.fault, one.mode, one.seed); });

  Table table{"safety",
              "What a fault of a device comes to",
              {"device", "fault", "hold, at most", "hold, ms", "fastest, mm/s", "rest, ms", "way, mm",
               "reason", "link"},
              {},
              "From the injection on, over four modes and the seeds; rest and way include what the machine "
              "brakes from its speed.",
              true};
  Table wrongs{"safety_wrong", "Cells that do not hold", {"device", "fault", "mode", "seed", "what"}, {}};
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (const std::string wrong = wrong_with(*cases[i].fault, cases[i].mode, all[i], setup); !wrong.empty())
      wrongs.add(cases[i].fault->device, cases[i].fault->name, mode_name(cases[i].mode), cases[i].seed,
                 wrong);
  double latest = 0.0;                      // over its bound
  double moving = 0.0, gone_farther = 0.0;  // cells in which the tip was to move; and than its bound
  for (std::size_t i = free; i < cases.size(); ++i) {
    const Case& one = cases[i];
    if (one.fault->end == End::unharmed || (one.mode != Mode::follow && one.mode != Mode::contact)) continue;
    ++moving;
    const Reaction& undisturbed = all[(i - free) % free];
    if (undisturbed.way > way_bound(*one.fault, all[i], setup)) ++gone_farther;
  }
  for (const Fault& fault : faults()) {
    Extremes hold, speed, rest, way;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (cases[i].fault != &fault) continue;
      hold.add(all[i].hold);
      if (fault.end != End::unharmed) latest = std::max(latest, all[i].hold / fault.hold_in(cases[i].mode));
      speed.add(1e3 * all[i].speed);
      rest.add(all[i].rest);
      way.add(1e3 * all[i].way);
    }
    const bool unharmed = fault.end == End::unharmed;
    table.add(fault.device, fault.name,
              unharmed              ? "never"
              : fault.hold_away > 0 ? fmt::format("{:g} ms; away {:g} ms", fault.hold, fault.hold_away)
                                    : fmt::format("{:g} ms", fault.hold),
              unharmed ? "" : range(hold.least, hold.most, "{:.0f}"),
              unharmed ? "" : range(speed.least, speed.most, "{:.1f}"),
              unharmed ? "" : range(rest.least, rest.most, "{:.0f}"),
              unharmed ? "" : range(way.least, way.most, "{:.2f}"), unharmed ? "" : why_text(fault.why),
              words(fault.end));
  }
  bench.table(std::move(table));
  bench.figure("safety.wrong.count", static_cast<double>(wrongs.rows.size()), "", exactly(0),
               fmt::format("of {} cells: fault x device x mode x seed", cases.size() - free));
  bench.figure(
      "safety.gone_farther.share", gone_farther / moving, "", at_least(0.5),
      "of the cells in follow and contact: without the fault the tip would have gone farther than the "
      "bound of its way");
  bench.figure("safety.hold_over_bound.max", latest, "", at_most(1.0));
  if (!wrongs.rows.empty()) bench.table(std::move(wrongs));
}

}  // namespace enc::bench::wires
