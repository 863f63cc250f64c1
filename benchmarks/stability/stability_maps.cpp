// Walls over stiffness, delay, period, damping and grip: predicted by the certificate's own release, spot
// checks by MuJoCo.
#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "benchmarks/stability/stability.h"
#include "benchmarks/stiffness/push_study.h"
#include "core/base/units.h"
#include "core/control/scene/scene.h"
#include "core/control/scene/steadiness.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/assemble.h"
#include "trial/certificates.h"

namespace enc::bench::stability {
namespace {

using certificate::Rest;

struct Panel {
  std::string title;
  Device device;  // the delay comes from the place
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

Rest foretold(const BenchContext& context, const Panel& panel, std::size_t delay, double stiffness) {
  const Device device = believed(context, late_device(panel, delay));
  // A device that friction holds against law and hand never moves, however long it is watched.
  const double reads = kLetGo + 0.5 * device.count;
  if (stiffness * reads + device.hand_spring * kLetGo < device.friction) return Rest::still;
  return certificate::release(loop_of(device), steps_of(device), stiffness, panel.damper, kLetGo).rest;
}

// The lowest stiffness on the circle. A spring alone is stable below it, so no eigenvalue is needed: with 500
// periods of delay that would take seconds.
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
    return Spot{stiffness, foretold(bench.context, panel, at.delay, stiffness),
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
    return std::pair{foretold(bench.context, panel, c.delay, c.stiffness), Bounds5{}};
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

// Friction and encoder counts: whether a released device comes to rest.

constexpr Stepping kFine{Scheme::rk4, 10};

// A device with the friction of a small arm.
Device rubbed(double damping, double delay) {
  Device device{0.1, damping, 1e-3, delay};
  device.friction = 0.05;
  device.count = 30e-6;
  return device;
}

struct Cell {
  Device device;
  double stiffness = 1000.0, x0 = 1e-3;
};
struct PredictionOutcome {
  certificate::Rest predicted = certificate::Rest::unknown;
  Outcome outcome = Outcome::away;
};

PredictionOutcome judge(const BenchContext& context, const Cell& cell) {
  const Device device = believed(context, cell.device);
  return {certificate::release(loop_of(device), steps_of(device), cell.stiffness, 0.0, cell.x0).rest,
          let_go(cell.device, {cell.stiffness, 0.0}, kFine, cell.x0)};
}

struct Grid {
  const char* name;
  double x0, stiffness, count;  // m, N/m, m
  double least, most;           // N s/m, damping: a range around that of the boundary
};
// One grid for each disturbance that comes to rest for some of its cells. One with counts that push more than
// friction holds (K step > 2 f_c): its `still` cells continue by less than 1 % of the disturbance.
constexpr Grid kGrids[] = {{"0.1mm", certificate::kSmall, 3000.0, 30e-6, 0.25, 16.0},
                           {"1mm", certificate::kLarge, 1000.0, 30e-6, 0.02, 8.0},
                           {"counts", certificate::kLarge, 1000.0, 150e-6, 0.02, 8.0}};

// Damping x delay at one stiffness, and the predicted share of it.
void add_grid(Bench& bench, const Grid& grid) {
  std::vector<Cell> all;
  const int rows = bench.context.full ? 12 : 7, columns = bench.context.full ? 11 : 6;
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) {
      const double delay = 0.5e-3 * std::round(10.0 * k / (columns - 1));
      const double damping = grid.least * std::pow(grid.most / grid.least, i / (rows - 1.0));
      all.push_back({rubbed(damping, delay), grid.stiffness, grid.x0});
      all.back().device.count = grid.count;
    }
  const auto judged = bench.each(all, [&](const Cell& cell) { return judge(bench.context, cell); });
  Agreement agreed;
  double still = 0.0;
  Table table{fmt::format("regions_{}", grid.name),
              fmt::format("Let go {:g} mm beside the edge of a wall of {:g} N/mm, counts of {:g} um",
                          grid.x0 * kMmPerM, grid.stiffness * 1e-3, grid.count * 1e6),
              {"b (N s/m)", "delay (ms)", "foretold", "MuJoCo"}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const certificate::Rest found = same_as(judged[i].outcome), told = judged[i].predicted;
    agreed.see(told, found);
    still += found == certificate::Rest::still ? 1.0 : 0.0;
    table.add(fmt::format("{:.3g}", all[i].device.damping), fmt::format("{:g}", all[i].device.delay * 1e3),
              word_of(told), word_of(found));
  }
  const double share = 100.0 / static_cast<double>(all.size());
  const auto id = [&](const char* what) { return fmt::format("regions.{}.{}", grid.name, what); };
  bench.figure(id("agree"), agreed.rest * share, "%", at_least(95.0),
               fmt::format("of {} of damping x delay: rests or does not, as foretold", all.size()));
  bench.figure(id("same"), agreed.same * share, "%", at_least(95.0),
               "the same, with limit cycles told from what runs away");
  bench.figure(id("still"), still * share, "%", "of them rest");
  bench.table(std::move(table));
}

// A device with all effects: well damped, with coarse counts, 2 f_c/step = 267 N/m below 2 b/T = 2000.
Device of_map(double delay) {
  Device device = rubbed(1.0, delay);
  device.friction = 0.02;
  device.count = 150e-6;
  return device;
}

std::vector<Series> bound_lines(const std::vector<double>& delays, double low, double high) {
  std::vector<Series> lines;
  for (const double delay : delays) {
    Device device = of_map(delay);
    device.hand_mass = 0.1;
    device.hand_damping = 4.0;
    device.hand_spring = 300.0;
    const auto rows = certificate::bounds(loop_of(device), steps_of(device), {1.0, {}});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto at = std::find_if(lines.begin(), lines.end(),
                                   [&](const Series& line) { return line.name == rows[i].name; });
      Series& line = at != lines.end() ? *at : lines.emplace_back(Series{.name = rows[i].name});
      line.add(delay * 1e3, rows[i].bound >= low && rows[i].bound <= high ? rows[i].bound : kUnset);
    }
  }
  return lines;
}

// Stiffness x delay, with all bounds.
void add_map(Bench& bench) {
  std::vector<Cell> all;
  std::vector<double> delays;
  const int columns = bench.context.full ? 21 : 6, rows = bench.context.full ? 15 : 9;
  delays.reserve(static_cast<std::size_t>(columns));
  for (int i = 0; i < columns; ++i) delays.push_back(1e-4 * std::round(100.0 * i / (columns - 1)));
  constexpr double kLow = 3.0, kHigh = 3e4;
  for (const double delay : delays)
    for (int k = 0; k < rows; ++k)
      all.push_back({of_map(delay), kLow * std::pow(kHigh / kLow, k / (rows - 1.0)), 1e-3});
  const auto found = bench.each(all, [](const Cell& c) {
    return static_cast<int>(let_go(c.device, {c.stiffness, 0.0}, kFine, c.x0));
  });
  Plot plot{.id = "map",
            .title = "A wall of stiffness and delay: what becomes of 1 mm",
            .x_label = "delay (ms)",
            .y_label = "stiffness (N/m)",
            .log_y = true};
  const char* const names[] = {"MuJoCo: rests", "limit cycle", "runs away", "not known"};
  for (int outcome = 0; outcome < 4; ++outcome) {
    Series points{.name = names[outcome], .mark = Mark::points};
    for (std::size_t i = 0; i < all.size(); ++i)
      if (found[i] == outcome) points.add(all[i].device.delay * 1e3, all[i].stiffness);
    if (outcome == 3 && points.x.empty()) continue;
    plot.series.push_back(std::move(points));
  }
  for (Series& line : bound_lines(delays, kLow, kHigh)) plot.series.push_back(std::move(line));
  plot.caption =
      "b 1 N s/m, 0.1 kg, T 1 ms, friction 0.02 N, counts of 150 um, nobody touches it. Up to exact_alone "
      "every "
      "swing dies out until counts are left; from abbott_okamura on these go on, and are drawn as a limit "
      "cycle "
      "where they are more than 1 % of the 1 mm. Up to friction_large friction stops what is unstable. "
      "exact_with_hand: with 0.1 kg, 4 N s/m, 300 N/m on it, which the points are without.";
  bench.plot(std::move(plot));
}

// Z-width: the softest to the stiffest object that a device renders stably, beside published values of other
// devices.

struct Width {
  std::string device, what, brief;
  double low, high;  // N/mm; low 0: no lower limit
  std::string source;
  const char* kind;  // a series of the plot
};

// From low to high, one after the other; a series for each kind.
void draw_widths(const std::vector<Width>& all, Plot& plot) {
  constexpr double kEdge = 1e-3;  // N/mm: end of an axis without a 0
  for (const Width& width : all) {
    auto at = std::find_if(plot.series.begin(), plot.series.end(),
                           [&](const Series& s) { return s.name == width.kind; });
    if (at == plot.series.end())
      at = plot.series.insert(plot.series.end(), Series{.name = width.kind, .mark = Mark::points});
    const double low = std::isnan(width.low) ? width.high : std::max(width.low, kEdge);
    at->add(static_cast<double>(plot.x_names.size()), Value(width.high, low, width.high));
    plot.x_names.push_back(width.brief);
  }
}

std::vector<Width> width_of_arm(const Bench& bench) {
  const models::Setup setup = models::load(bench.context.models + "/scenes/wall.toml", {});
  const certificate::Certificate wall =
      trial::certificates_of(setup, trial::prepare_setup(setup)).back().certificate;
  const auto bound = [&](const char* name) {
    return certificate::row_of(wall, name).bound / kNewtonPerMillimetre;
  };
  const std::string device = "arm of VisHap, its law", source = "certificate of wall.toml";
  return {{device, "passive, whatever hand", "arm", 0.0, bound("colgate_schenkel"), source, "passive"},
          {device, "stable alone", "arm", 0.0, bound("exact_alone"), source, "stable alone"},
          {device, "with the hand", "arm", 0.0, bound("exact_with_hand"), source, "with a hand"}};
}

// No upper limit was found: it stands still up to the stiffest object of any map.
std::vector<Width> width_of_hexapod(const Bench& bench) {
  const models::Setup setup = models::load(bench.context.models + "/scenes/stiffness.toml", {});
  const Steadiness loop(setup.rig);
  double stiffest = 0.0;
  const auto decades = static_cast<int>(std::lround(std::log10(kHardest / 1e3)));
  for (int i = 0; i <= decades; ++i) {
    const double k = 1e3 * std::pow(10.0, i);
    const Response spring({{k, 0, 0, 0}, {k, 0, 0, 0}, 23e-3}, 0.0);
    if (loop.swing(spring, std::min(15e-3, 30.0 / k), 23e-3, Steadiness::kSlow) > loop.still()) break;
    stiffest = k;
  }
  const std::string device = "hexapod of VHMR",
                    hand = fmt::format("{:g} N/mm", loop_of(setup.rig).hand_stiffness / kNewtonPerMillimetre);
  return {{device, "linear, with a hand of " + hand, "hexapod",
           lowest_stable_stiffness(loop_of(setup.rig)) / kNewtonPerMillimetre,
           stiffest / kNewtonPerMillimetre, "row admittance", "with a hand"},
          {device, "with all limits, pushed in 2 s", "hexapod",
           loop.softest(15e-3, 30.0, Steadiness::kSlow) / kNewtonPerMillimetre,
           stiffest / kNewtonPerMillimetre, "core/control/scene/steadiness.h", "with a hand, all limits"}};
}

std::vector<Width> published() {
  const char* known = "published";
  const char* recalled = "from memory";
  return {{"hexapod of VHMR, the real one", "rendered; within 2 % from 0.3 N/mm", "VHMR", 0.03, 200.0,
           "[VHMR 2, Fig 3]", known},
          {"PHANToM, textures felt clean", "the stiffest, at 0.25 to 40 kHz", "PHANToM, clean", 0.325, 0.904,
           "Choi and Tan 2004 (studylib.net/doc/18564039)", known},
          {"PHANToM Premium 1.5, its structure", "a wall cannot be stiffer", "Premium 1.5", kUnset, 3.5,
           "SensAble's sheet [sources/arm 1]", known},
          {"omega.3 (Force Dimension)", "closed loop, the stiffest", "omega.3", kUnset, 14.5,
           "vendor's sheet", recalled},
          {"HapticMaster (admittance)", "the stiffest, by the place", "HapticMaster", 10.0, 50.0,
           "Van der Linde 2002", recalled}};
}

using certificate::Rest;

// A machine that measures force: the rendered stiffness over dead time, period and grip. Predicted by the
// large-signal loop of core/control/scene/steadiness.h, spot checks by the twin.

struct PushCase {
  const char* name;
  double stiffness, damping;  // N/m, N s/m
};
constexpr std::array<PushCase, 3> kHands{
    {{"0.13 N/mm", 130.0, 2.0}, {"0.7 N/mm", 700.0, 4.0}, {"2 N/mm", 2000.0, 8.0}}};
constexpr std::array kTicks{0.1e-3, 1e-3, 10e-3};  // s
constexpr std::size_t kOwn = 1;                    // index of the machine's own value: the twin runs with it
constexpr double kPushDepth = 15e-3, kPushForce = 30.0,
                 kPushLimit = 23e-3;  // m, N, m: of the scene `stiffness`
constexpr double kAway = 20e-3;       // m, of the tip
constexpr std::size_t kEnough = 60;   // places: with fewer, one or two beside the boundary are more than 5 %

models::Setup pushed_setup(const BenchContext& context, const PushCase& hand, double period, double delay) {
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

// The twin with the scene's push.
Rest pushed(const models::Setup& setup, double stiffness, std::uint64_t seed) {
  const Steadiness loop(setup.rig);
  const auto push = stiffness::push_once(stiffness::with_stiffness(setup, stiffness), seed);
  return by_swing(push.peak_to_peak, loop.still());
}

void add_spots(Bench& bench, const std::vector<std::string>& titles) {
  const BenchContext& context = bench.context;
  std::vector<Place> places = random_places(context, kHands.size(),
                                            context.full    ? 400
                                            : context.quick ? 12
                                                            : 24,
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
    models::Setup told = setup;
    if (context.mutated("ten_times_damped")) told.rig.contact.hand_stiffness *= 10.0;
    return Spot{stiffness, foretold(told, stiffness), pushed(setup, stiffness, context.seed)};
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
               at_least(places.size() < kEnough ? 85.0 : 95.0),
               fmt::format("of {} random places of the admittance's map: stands still in the twin, as "
                           "foretold",
                           places.size()));
  bench.table(std::move(table));
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
  const std::size_t count = full ? 300 : quick ? 12 : 20;
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

void add_regions(Bench& bench) {
  for (const Grid& grid : kGrids) add_grid(bench, grid);
  add_map(bench);
}

void add_widths(Bench& bench) {
  std::vector<Width> all = width_of_arm(bench);
  for (const auto& more : {width_of_hexapod(bench), published()})
    all.insert(all.end(), more.begin(), more.end());
  Table table{
      "widths", "Z-width: what a device renders", {"device", "what", "from (N/mm)", "to (N/mm)", "source"}};
  Plot plot{.id = "widths",
            .title = "From the softest to the stiffest that is rendered",
            .x_label = "",
            .y_label = "stiffness (N/mm)",
            .log_y = true};
  const auto number = [](double k) { return std::isnan(k) ? std::string("-") : fmt::format("{:.3g}", k); };
  for (const Width& width : all) {
    const bool recalled = std::string_view(width.kind) == "from memory";
    table.add(width.device, width.what, number(width.low), number(width.high),
              width.source + (recalled ? " (from memory)" : ""));
  }
  draw_widths(all, plot);
  table.note =
      "An arm renders nothing softly without end: from 0; its friction of some 0.05 N hides what is softer "
      "than "
      "0.005 N/mm at 10 mm. A machine that measures force is passive for no stiffness: to each there is a "
      "hand "
      "that makes it swing. It stands still up to the stiffest that was asked.";
  plot.caption =
      "An arm is limited where it is stiff, a machine that measures force where it is soft. From 15 to 42 "
      "N/mm on a "
      "wall is felt to be rigid (Tan et al. 1994). Sources: table `widths`.";
  bench.table(std::move(table));
  bench.plot(std::move(plot));
  bench.figure("widths.arm.decades", std::log10(all[1].high / 5e-3), "",
               "from what the arm's friction hides at 10 mm, 0.005 N/mm, to what is stable alone: decades");
  bench.figure("widths.hexapod.decades", std::log10(all[4].high / all[4].low), "",
               "of the hexapod, with all limits: decades");
}

void add_admittance_map(Bench& bench) {
  struct Cell {
    std::size_t panel, delay;
    double stiffness;
  };
  std::vector<std::string> titles;
  std::vector<Cell> all;
  for (const PushCase& hand : kHands)
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
