// Walls over stiffness, delay, period, damping and grip: foretold by the certificate's own release, spot
// checks by MuJoCo.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/stability/maps.h"

namespace enc::bench::stability {
namespace {

using certificate::Rest;

struct Panel {
  std::string title;
  Device device;  // its delay is that of the place
  double damper = 0.0;
};

constexpr double kLetGo = certificate::kLarge;
constexpr double kRubs = 0.05;  // N, dry
constexpr double kQuarter = 3.14159265358979 / 4.0;

// Friction and counts of a small arm.
Device small_arm(double damping, double period) {
  Device device{0.1, damping, period, 0.0};
  device.friction = kRubs;
  device.count = 30e-6;
  return device;
}

std::vector<Panel> grip_panels() {
  std::vector<Panel> all;
  for (const Grip& grip : kGrips)
    for (const double period : {0.1e-3, 1e-3, 10e-3})
      all.push_back(
          {fmt::format("{}, every {:g} ms", grip.name, period * 1e3), held_by(small_arm(0.2, period), grip)});
  return all;
}
std::vector<Panel> damping_panels() {
  std::vector<Panel> all;
  for (const double damping : {0.02, 0.2, 2.0})
    for (const double damper : {0.0, 0.5, 5.0})
      all.push_back({fmt::format("b {:g}, B {:g} N s/m", damping, damper), small_arm(damping, 1e-3), damper});
  return all;
}

Device late_device(const Panel& panel, std::size_t delay) {
  Device device = panel.device;
  device.delay = kDelays[delay];
  return device;
}

Rest foretold(const Panel& panel, std::size_t delay, double stiffness) {
  const Device device = late_device(panel, delay);
  // Where friction holds what law and hand pull with it never moves, however long that is watched.
  const double reads = kLetGo + 0.5 * device.count;
  if (stiffness * reads + device.hand_spring * kLetGo < device.friction) return Rest::still;
  return certificate::release(loop_of(device), steps_of(device), stiffness, panel.damper, kLetGo).rest;
}

// The lowest stiffness that is on the circle. A spring alone is stable below it, so no eigenvalue has to be
// looked at: with 500 periods of delay that would take seconds.
double exact(const certificate::SampledLoop& loop, double damper, double dry) {
  const certificate::Damper fixed{damper, 0.0};
  if (damper > 0.0 && dry == 0.0) return certificate::critical_stiffness(loop, fixed);
  if (damper > 0.0) return certificate::friction_stiffness(loop, kRubs, fixed, kLetGo);
  for (const certificate::Edge& edge : certificate::edges(loop, fixed, dry))
    if (edge.leave > 0) return edge.stiffness;
  return kUnset;
}

struct Bounds5 {
  double passive, formula, eigenvalues, rubbed, counts;
};
Bounds5 map_bounds(const Panel& panel, std::size_t delay) {
  const Device device = late_device(panel, delay);
  const certificate::SampledLoop loop = loop_of(device);
  const certificate::Damper fixed{panel.damper, 0.0};
  return {certificate::passive_stiffness(loop.alone(), fixed),
          certificate::delayed_stiffness(loop.alone(), fixed), exact(loop, panel.damper, 0.0),
          exact(loop, panel.damper, device.friction / (kQuarter * kLetGo)),
          2.0 * device.friction / device.count};
}

void add_lines(Map& map, std::size_t panel, std::size_t delay, const Bounds5& at) {
  map.line("eigenvalues", panel, delay, at.eigenvalues);
  map.line("(b + B)/(T/2 + delay) (Gil, Hulin)", panel, delay, at.formula);
  map.line("with dry friction, at 1 mm", panel, delay, at.rubbed);
  map.line("passive (Colgate, Schenkel)", panel, delay, at.passive);
  map.line("2 f_c/count (Abbott, Okamura)", panel, delay, at.counts);
}

// MuJoCo at random places of the panels.
void spot_checks(Bench& bench, const std::vector<Panel>& panels, std::size_t count, std::uint64_t stream,
                 Agreement& agreed, Table& table) {
  const std::vector<Place> places = random_places(bench.context, panels.size(), count, stream);
  struct Spot {
    double stiffness;
    Rest told, seen;
  };
  const auto found = bench.each(places, [&](const Place& at) {
    const Panel& panel = panels[at.panel];
    const Device device = late_device(panel, at.delay);
    int steps = device.period < 0.5e-3 ? 2 : device.period < 5e-3 ? 10 : 50;
    while (std::abs(std::remainder(device.delay, device.period / steps)) > 1e-9) ++steps;  // as Slide wants
    const double rubbed = exact(loop_of(device), panel.damper, device.friction / (kQuarter * kLetGo));
    const double stiffness = about(rubbed, at.share);
    return Spot{stiffness, foretold(panel, at.delay, stiffness),
                same_as(let_go(device, {stiffness, panel.damper}, {Scheme::rk4, steps}, kLetGo))};
  });
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [stiffness, told, seen] = found[i];
    agreed.see(told, seen);
    table.add(panels[places[i].panel].title, kDelays[places[i].delay] * 1e3, fmt::format("{:.3g}", stiffness),
              words_of(told), words_of(seen));
  }
}

void add_panels(Bench& bench, Map& map, const std::vector<Panel>& panels, const std::string& caption) {
  struct Cell {
    std::size_t panel, delay;
    double stiffness;  // unset: the bounds there
  };
  std::vector<Cell> all;
  std::vector<double> rows = stiffnesses(bench.context);
  rows.push_back(kUnset);
  for (std::size_t panel = 0; panel < panels.size(); ++panel)
    for (std::size_t delay = 0; delay < kDelays.size(); ++delay)
      for (const double stiffness : rows) all.push_back({panel, delay, stiffness});
  const auto found = bench.each(all, [&](const Cell& c) {
    const Panel& panel = panels[c.panel];
    if (std::isnan(c.stiffness)) return std::pair{Rest::unknown, map_bounds(panel, c.delay)};
    return std::pair{foretold(panel, c.delay, c.stiffness), Bounds5{}};
  });
  for (std::size_t i = 0; i < all.size(); ++i)
    if (std::isnan(all[i].stiffness))
      add_lines(map, all[i].panel, all[i].delay, found[i].second);
    else
      map.cell(all[i].panel, all[i].delay, all[i].stiffness, found[i].first);
  map.add_to(bench, caption);
}

std::vector<std::string> titles(const std::vector<Panel>& panels) {
  std::vector<std::string> all;
  all.reserve(panels.size());
  for (const Panel& panel : panels) all.push_back(panel.title);
  return all;
}

}  // namespace

void add_wall_maps(Bench& bench) {
  const std::vector<Panel> grips = grip_panels(), dampings = damping_panels();
  Map by_grip("map_wall", "A wall, let go 1 mm beside its edge: who holds it, and how often it is computed",
              titles(grips), 3);
  add_panels(
      bench, by_grip, grips,
      "A spring without damper; 0.1 kg, b 0.2 N s/m, friction 0.05 N, counts of 30 um. A fingertip: 6 g, "
      "2 N s/m, "
      "300 N/m; a firm grip: 150 g, 10 N s/m, 2000 N/m. What is soft rests because friction holds it. "
      "Without a damper in the wall the formula of Gil and Hulin and the bound of passivity are nearly the "
      "same.");
  Map by_damping("map_damping", "The same, held by nobody, every 1 ms: damping of device and wall",
                 titles(dampings), 3);
  add_panels(
      bench, by_damping, dampings,
      "b: of the device, viscous; B: of the wall, from differences. A damper that is computed late drives: "
      "with B of 5 N s/m at 50 ms no stiffness is stable, and what rests is held by friction. From B above b "
      "on nothing is passive, and no line is drawn.");
  Table table{
      "map_spots", "Spot checks of the maps", {"panel", "delay (ms)", "K (N/m)", "foretold", "MuJoCo"}};
  const bool quick = bench.context.quick, full = bench.context.full;
  const std::size_t count = full ? 300 : quick ? 12 : 50;
  Agreement all;
  spot_checks(bench, grips, count, 1, all, table);
  spot_checks(bench, dampings, count, 2, all, table);
  bench.figure("maps.agree", 100.0 * all.rest / all.places, "%", at_least(95.0),
               fmt::format("of {} random places of the walls' maps: rests or does not in MuJoCo, as foretold",
                           all.places));
  bench.figure("maps.same", 100.0 * all.same / all.places, "%",
               "the same, with limit cycles told from what runs away");
  bench.table(std::move(table));
}

}  // namespace enc::bench::stability
