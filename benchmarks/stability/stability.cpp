// Stable walls: the certificate's exact eigenvalues, bounds and release against a slide in MuJoCo that is
// written independently (docs/reference/stability.md).
#include "benchmarks/stability/stability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/statistics.h"
#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/assemble.h"
#include "trial/certificates.h"

namespace enc::bench::stability {
namespace {

// Effect of MuJoCo's integrators on the boundary of a sampled wall [sources/twin 1].

struct SteppedLoop {
  Scheme scheme;
  int steps;
  double delay;  // s
};
struct MarginShift {
  double factor = kUnset, expected = kUnset;  // factors on the critical stiffness
};

// (T/2 + t_d)/(T/2 + t_d - h/2) for the first-order integrators: their position is that of half a step later.
MarginShift moved_by(const BenchContext& context, const SteppedLoop& s) {
  const Device device{0.1, 0.2, 1e-3, s.delay};
  const double exact = certificate::critical_stiffness(loop_of(believed(context, device)));
  const double lag = 0.5e-3 + s.delay;
  const double gained = s.scheme == Scheme::rk4 ? 0.0 : 0.5e-3 / s.steps;
  const double simulated = critical(device, 0.0, {s.scheme, s.steps}, kUnset, 50.0 * exact);
  return {simulated / exact, lag / std::max(0.0, lag - gained)};
}

// The certificate of every scene that ships, and its cost (trial/certificates.h).

std::string in_mm(double per_metre) {
  return std::isfinite(per_metre) ? fmt::format("{:.4g}", 1e-3 * per_metre) : std::string();
}

// N/mm; empty if the certificate has no such row.
std::string told(const trial::ObjectCertificate& one, const char* name, double certificate::Row::*of) {
  for (const certificate::Row& row : one.certificate.rows)
    if (row.name == name) return sign_of(row.side) + in_mm(row.*of);
  return {};
}

// Error against run time: the effect of time step and integrator on the critical stiffness, and their cost.

constexpr std::array kStepCounts{1, 2, 5, 10, 20};  // of a period
constexpr double kTimedPeriod = 1e-3;               // s
constexpr int kTimedPeriods = 1000;                 // periods of a timed run

struct Setting {
  Scheme scheme;
  int steps;
  double delay;                          // s
  double error = kUnset, cost = kUnset;  // %; s of CPU for each second
  bool none = false;                     // stable for every stiffness: the run failed
};

Device timed_device(double delay) { return {0.1, 0.2, kTimedPeriod, delay}; }

Setting timed(const BenchContext& context, Setting s) {
  const Device device = timed_device(s.delay);
  const double exact = certificate::critical_stiffness(loop_of(believed(context, device)));
  const double found = critical(device, 0.0, {s.scheme, s.steps}, kUnset, 50.0 * exact);
  s.none = std::isinf(found);
  s.error = s.none ? kUnset : std::max(100.0 * std::abs(found / exact - 1.0), 1e-3);
  return s;
}

using certificate::Rest;

// A button that is pressed to its bottom, in MuJoCo, over stiffness, delay, period and grip. Its force falls
// at the trigger, so an unstable button hops between its branches.

constexpr double kTrigger = 2e-3, kFall = 0.5e-3, kBottom = 4e-3, kBelow = 2e-3;  // m, deep
constexpr double kKeyAside = 1e-3;  // m, beside its place of rest
constexpr double kKeyStep = 1e-3;   // s, RK4

// N: resistance up to the trigger, half of it behind, a floor [VisHap Fig 4]; `floor`, N/m, is the stiffest
// part.
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

// A finger presses the key, with its grip 2 mm below the bottom: that is x = 0.
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

constexpr double kMost = 1e6;  // N/m, start of the downward search

struct Case {
  Device device;
  double damper = 0.0;
  int steps = 1;  // the fewest steps that the delay allows
};

Device device_of(double damping, double delay_ms, double mass = 0.1, double period = 1e-3) {
  return {mass, damping, period, delay_ms * 1e-3};
}
Device held(Device device) {
  device.hand_mass = 0.1;
  device.hand_damping = 4.0;
  device.hand_spring = 300.0;
  return device;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double damping : {0.05, 0.2, 1.0})
    for (const double damper : {0.0, 0.5, 2.0})
      for (const double delay : {0.0, 1.0, 3.0, 10.0}) all.push_back({device_of(damping, delay), damper});
  for (const double mass : {0.075, 1.0})
    for (const double damper : {0.0, 0.1})
      for (const double delay : {0.0, 2.0, 5.0}) all.push_back({device_of(0.2, delay, mass), damper});
  for (const double damper : {0.0, 2.0})
    for (const double delay : {0.0, 1.0, 2.0, 5.0, 10.0})
      all.push_back({held(device_of(0.2, delay)), damper});
  for (const double delay : {0.0, 1.0, 2.0, 5.0, 10.0}) all.push_back({device_of(0.2, delay), 10.0});
  for (const double period : {0.5e-3, 2e-3})
    for (const double delay : {0.0, 4.0}) all.push_back({device_of(0.2, delay, 0.1, period), 0.0});
  for (const double damper : {0.0, 1.0}) {
    for (const double delay : {0.5, 1.5}) all.push_back({device_of(0.2, delay), damper, 2});
    for (const double delay : {0.3, 2.7}) all.push_back({device_of(0.2, delay), damper, 10});
  }
  // Dampers of the wall: as much damping as the device, up to a damper that stops it within the delay.
  for (const auto& [mass, damping] : {std::pair{0.1, 0.2}, {0.1, 1.0}, {0.1, 5.0}})
    for (const double delay : {0.0, 1.0, 3.0, 10.0})
      all.push_back({device_of(damping, delay, mass), damping});
  return all;
}

struct StabilityResult {
  double predicted = kUnset, formula = kUnset;
  double at[3] = {kUnset, kUnset, kUnset};  // at 1, 2, 10 steps a period; unset: no whole number of them
  double error = 0.0;                       // %, the largest
  int judged = 0;                           // of those steps
  bool applies = false;                     // the certificate says whether the formula applies
};
constexpr int kSteps[] = {1, 2, 10};

StabilityResult find(const Case& of, const BenchContext& context) {
  StabilityResult found;
  const certificate::Damper damper{of.damper, 0.0};
  const certificate::SampledLoop loop = loop_of(believed(context, of.device));
  found.predicted = certificate::critical_stiffness(loop, damper);
  for (const certificate::Row& row : certificate::bounds(loop, {0.0, 0.0}, {1.0, damper}))
    if (row.name == "gil_hulin") {
      found.formula = row.bound;
      found.applies = row.applies;
    }
  double near = kUnset;
  for (std::size_t i = 0; i < (context.full ? 3U : 2U); ++i) {
    if (kSteps[i] < of.steps) continue;
    near = found.at[i] = critical(of.device, of.damper, {Scheme::rk4, kSteps[i]}, near, kMost);
    const double error = 100.0 * std::abs(found.predicted / near - 1.0);
    found.error = worse(found.error, error);
    ++found.judged;
  }
  return found;
}

void add_table(Bench& bench, const std::vector<Case>& all, const std::vector<StabilityResult>& found) {
  Table table{"critical",
              "Critical stiffness: eigenvalues, MuJoCo, Gil and Hulin's formula",
              {"mass (kg)", "b (N s/m)", "B (N s/m)", "T (ms)", "delay (ms)", "hand", "eigenvalues (N/m)",
               "step T (N/m)", "T/2 (N/m)", "T/10 (N/m)", "formula (N/m)", "largest error (%)"}};
  const auto number = [](double x) { return std::isnan(x) ? std::string("-") : fmt::format("{:.5g}", x); };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Device& d = all[i].device;
    const StabilityResult& f = found[i];
    table.add(d.mass, d.damping, all[i].damper, d.period * 1e3, d.delay * 1e3,
              d.hand_spring > 0.0 ? "yes" : "no", number(f.predicted), number(f.at[0]), number(f.at[1]),
              number(f.at[2]), number(f.formula), fixed(f.error, 3));
  }
  table.note = "Hand: 0.1 kg, 4 N s/m, 300 N/m. Step: MuJoCo's, RK4. Formula: (b + B)/(T/2 + delay).";
  bench.table(std::move(table));
}

// The formula against the result, with and without its own condition.
void add_formula(Bench& bench, const std::vector<Case>& all, const std::vector<StabilityResult>& found) {
  double within = 0.0, late = 0.0, beyond = 0.0;
  int applied = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Device& d = all[i].device;
    if (d.hand_spring > 0.0) continue;
    double simulated = kUnset;  // result at the coarsest possible step
    for (const double k : found[i].at)
      if (std::isnan(simulated)) simulated = k;
    double& most = found[i].applies ? within : all[i].damper <= d.damping ? late : beyond;
    most = worse(most, 100.0 * (found[i].formula / simulated - 1.0));
    applied += found[i].applies ? 1 : 0;
  }
  bench.figure("gil_hulin.cases.value", applied, "", "of the cases, that it applies to");
  bench.figure("gil_hulin.within.max", within, "%", at_most(5.0),
               "by how much (b + B)/(T/2 + delay) is above what MuJoCo does, where it applies: B up to b, b "
               "(2 T + delay) up to 0.1 m");
  bench.figure("gil_hulin.late.max", late, "%", "the same, B up to b, longer delays: there it is no bound");
  bench.figure("gil_hulin.beyond.max", beyond, "%", "the same, B above b: neither");
}

void add_no_stiffness(Bench& bench) {
  std::vector<double> all;
  for (int i = 0; i <= 32; ++i) all.push_back(1e-2 * std::pow(10.0, 0.25 * i));
  const double damper = bench.context.mutated("damper_of_1") ? 1.0 : 20.0;  // N s/m
  const auto grown = bench.each(all, [&](double stiffness) {
    return growth(device_of(0.2, 10.0), {stiffness, damper}, {Scheme::rk4, 1});
  });
  bench.figure(
      "damper20.unstable.percent",
      100.0 *
          static_cast<double>(std::count_if(grown.begin(), grown.end(), [](double g) { return g > 0.0; })) /
          static_cast<double>(grown.size()),
      "%", exactly(100.0), "of 33 stiffnesses from 0.01 to 1e6 N/m, 20 N s/m at 10 ms");
  bench.figure("damper20.predicted.value",
               certificate::critical_stiffness(loop_of(device_of(0.2, 10.0)), {damper, 0.0}), "N/m",
               exactly(0.0), "critical stiffness by the eigenvalues: none is stable");
}

// Cost of a certificate: the law of an arm, filtered, rates of two ticks, with a hand.
double seconds_of(double period, double delay_ms, int times, Yardstick& yardstick) {
  const Device device = held(device_of(0.0114, delay_ms, 0.075, period));
  certificate::SampledLoop loop = loop_of(device);
  loop.ticks = 2;
  loop.filter = 0.377;  // 60 Hz at 1 kHz
  std::vector<double> seconds;
  for (int i = 0; i < times; ++i) {
    yardstick.measure();
    const double start = thread_seconds();
    const certificate::Certificate found =
        certificate::certify(loop, {0.048, 28.7e-6}, {300.0 + i, {0.0, 11.5 / 300.0}});
    seconds.push_back(thread_seconds() - start);
    if (found.rows.empty()) throw Error("a certificate without rows");
  }
  return median(seconds);
}

void add_cost(Bench& bench) {
  Yardstick yardstick;
  const double arm = seconds_of(1e-3, 2.0, 15, yardstick), late = seconds_of(1e-3, 5.3, 15, yardstick);
  const double fine = seconds_of(1e-4, 10.0, 5, yardstick);
  bench.cost("certificate.time.median", 1e3 * arm, "ms", "CPU time of one, 1 kHz and 2 ms");
  bench.cost("certificate.late.time.median", 1e3 * late, "ms",
             "the same, 5.3 ms: later than any shipped arm");
  bench.cost("certificate.late.over_yardstick.median", late / yardstick.seconds(), "x",
             "the same over a fixed piece of work of the same run (kit/cost.h)");
  bench.cost("certificate.fine.time.median", 1e3 * fine, "ms",
             "the same, 10 kHz and 10 ms: 100 periods late");
}

struct KeyPanel {
  std::string title;
  Device device;  // the delay comes from the place
};
std::vector<KeyPanel> key_panels() {
  std::vector<KeyPanel> all;
  for (const double period : {1e-3, 10e-3})
    for (const Grip& grip : kGrips)
      all.push_back({fmt::format("{}, every {:g} ms", grip.name, period * 1e3),
                     held_by({0.1, 0.2, period, 0.0}, grip)});
  return all;
}

std::vector<KeyCell> key_cells(const std::vector<KeyPanel>& panels, const BenchContext& context) {
  std::vector<KeyCell> all;
  for (std::size_t panel = 0; panel < panels.size(); ++panel)
    for (std::size_t delay = 0; delay < kDelays.size(); ++delay) {
      if (std::abs(std::remainder(kDelays[delay], kKeyStep)) > 1e-9) continue;  // no whole number of steps
      for (const double stiffness : stiffnesses(context)) {
        all.push_back({panel, delay, stiffness, panels[panel].device});
        all.back().device.delay = kDelays[delay];
      }
    }
  return all;
}

// A map of a button that is pressed to its bottom.
void add_button_map(Bench& bench) {
  const std::vector<KeyPanel> panels = key_panels();
  std::vector<std::string> titles;
  for (const KeyPanel& panel : panels) titles.push_back(panel.title);
  const std::vector<KeyCell> all = key_cells(panels, bench.context);
  const auto found = bench.each(all, key_outcome);
  Map map("map_button", "A button that is pressed to its bottom and moved 1 mm aside", titles, 3);
  double same = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const KeyCell& cell = all[i];
    const certificate::SampledLoop loop = loop_of(believed(bench.context, cell.device));
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
  map.add_to(bench,
             "All by MuJoCo: no friction, no counts. 2/3 of the stiffness up to 2 mm, 1/3 behind, all of it "
             "from 4 mm on: what its floor makes unstable is caught by the softer branches, or by the air "
             "above it, and goes on as a limit cycle.");
  bench.figure(
      "button.agree", 100.0 * same / static_cast<double>(all.size()), "%", at_least(95.0),
      fmt::format("of {} places of the button's map: rests in MuJoCo if the eigenvalues of its floor say so",
                  all.size()));
}

// The critical stiffness of linear walls, its error, and that of Gil and Hulin.
void add_linear_cases(Bench& bench) {
  std::vector<Case> all = cases();
  if (!bench.context.full) std::erase_if(all, [](const Case& of) { return of.steps > 2; });  // wants T/10
  const auto found = bench.each(all, [&](const Case& of) { return find(of, bench.context); });
  double worst = 0.0, judged = 0.0;
  for (const StabilityResult& f : found) {
    worst = worse(worst, f.error);
    judged += f.judged > 0 && std::isfinite(f.error) ? 1.0 : 0.0;
  }
  bench.figure("critical.cases.value", judged, "",
               "that have a critical stiffness on both sides, over b, B, delay, mass, period, hand, each at "
               "time step T, T/2 and T/10 where the delay allows");
  bench.figure("critical.error.max", worst, "%", at_most(0.1),
               "critical stiffness: exact eigenvalues against MuJoCo");
  add_formula(bench, all, found);
  add_no_stiffness(bench);
  add_table(bench, all, found);
}

// Effect of each integrator on the boundary.
void add_integrators(Bench& bench) {
  std::vector<SteppedLoop> all;
  for (const Scheme scheme : kSchemes)
    for (const int steps : {1, 2, 10})
      for (const double delay : {0.0, 1e-3, 2e-3, 5e-3}) all.push_back({scheme, steps, delay});
  const auto found = bench.each(all, [&](const SteppedLoop& s) { return moved_by(bench.context, s); });
  Table table{"integrators",
              "Critical stiffness in MuJoCo over the exact one",
              {"integrator", "time step", "delay (ms)", "factor", "expected"},
              {},
              "b 0.2 N s/m, 0.1 kg, T 1 ms. inf: stable up to 50 times the exact one."};
  for (const Scheme scheme : kSchemes) {
    double worst = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].scheme != scheme) continue;
      table.add(name_of(scheme), all[i].steps == 1 ? "T" : fmt::format("T/{}", all[i].steps),
                all[i].delay * 1e3, fixed(found[i].factor, 4), fixed(found[i].expected, 4));
      const bool none = std::isinf(found[i].factor) && std::isinf(found[i].expected);
      const double off = none ? 0.0 : 100.0 * std::abs(found[i].factor / found[i].expected - 1.0);
      worst = worse(worst, off);
      if (all[i].steps == 10) largest = worse(largest, found[i].factor);
    }
    bench.figure(fmt::format("{}.factor.tenth", name_of(scheme)), largest, "x",
                 "critical stiffness over the exact one, time step T/10, no delay");
    bench.figure(fmt::format("{}.factor_error.max", name_of(scheme)), worst, "%", at_most(0.2),
                 scheme == Scheme::rk4 ? "against 1, time steps T to T/10, delays 0 to 5 ms"
                                       : "against (T/2 + t_d)/(T/2 + t_d - h/2), the same");
  }
  bench.table(std::move(table));
}

// A mutant: an arm's force 20 ms late, or with a loop that is not known.
void loops_late(models::Setup& setup, bool unknown) {
  if (setup.rig.arm.loop) setup.rig.arm.loop->delay = 0.02;
  if (unknown) setup.rig.arm.loop.reset();
}

// The certificates of the scenes that ship.
void add_scenes(Bench& bench) {
  Table table{"stability_scenes",
              "What the shipped scenes render, as `check` certifies it",
              {"scene", "object", "class", "asks for (N/mm)", "passive to", "stable alone to",
               "with the hand to", "admittance from", "large signal from"}};
  double beyond = 0.0, unknown = 0.0, objects = 0.0, most = 0.0;
  const std::string& models = bench.context.models;
  for (const std::string& name : models::files_in(models, "scenes")) {
    models::Setup setup = models::load(models + "/scenes/" + name + ".toml", {});
    if (bench.context.mutated("late_loops")) loops_late(setup, name == "wall");
    const Scene scene = trial::prepare_setup(setup);
    const double start = thread_seconds();
    const std::vector<trial::ObjectCertificate> found = trial::certificates_of(setup, scene, true);
    most = std::max(most, thread_seconds() - start);
    for (const trial::ObjectCertificate& one : found) {
      using certificate::Row;
      ++objects;
      beyond += one.beyond() ? 1.0 : 0.0;
      unknown += one.unknown() ? 1.0 : 0.0;
      table.add(name, one.object.empty() ? "(none)" : one.object, word_of(one.certificate.verdict),
                in_mm(one.asked), told(one, "colgate_schenkel", &Row::bound),
                told(one, "exact_alone", &Row::bound), told(one, "exact_with_hand", &Row::bound),
                told(one, "admittance", &Row::low), told(one, "large_signal", &Row::low));
    }
  }
  table.note =
      "Of an arm: (none) is the tip that nobody touches. Of a machine that measures force the object asks "
      "for its softest slope.";
  bench.result.tables.push_back(std::move(table));
  bench.figure("scenes.objects.value", objects, "", "objects of shipped scenes that have a certificate");
  bench.figure("scenes.beyond.value", beyond, "", at_most(0.0),
               "of them, that are not stable under the hand that the rig expects");
  bench.figure("scenes.unknown.value", unknown, "", at_most(0.0), "of them, of which it is not known");
  bench.cost("scenes.time.max", 1e3 * most, "ms", "CPU time of all certificates of a scene, at most");
}

// Each integrator with each time step and delay, with its error and cost.
std::vector<Setting> timed_settings(Bench& bench) {
  std::vector<Setting> all;
  for (const double delay : {0.0, 2e-3})
    for (const Scheme scheme : kSchemes)
      for (const int steps : kStepCounts) all.push_back({scheme, steps, delay});
  all = bench.each(all, [&](const Setting& s) { return timed(bench.context, s); });
  std::vector<std::function<void()>> ways;
  ways.reserve(all.size());
  for (const Setting& s : all)
    ways.emplace_back([&s] {
      Slide slide(timed_device(s.delay), {30.0, 0.0}, {s.scheme, s.steps}, 1e-3);
      for (int i = 0; i < kTimedPeriods; ++i) slide.period();
    });
  const Race race(bench.context.quick ? 3 : 5, ways);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].cost = race.seconds(i) / (kTimedPeriods * kTimedPeriod);
  return all;
}

bool is_default(const Setting& s) { return s.scheme == Scheme::rk4 && s.steps == kStepCounts.front(); }

Table settings_table(const std::vector<Setting>& all) {
  Table table{"work_precision",
              "Error of the critical stiffness against run time",
              {"integrator", "time step", "delay (ms)", "error (%)", "CPU s per s"}};
  for (const Setting& s : all)
    table.add(name_of(s.scheme), s.steps == kStepCounts.front() ? "T" : fmt::format("T/{}", s.steps),
              s.delay * 1e3, s.none ? "failed: stable for every stiffness" : fmt::format("{:.3g}", s.error),
              fmt::format("{:.3g}", s.cost));
  return table;
}

Plot settings_plot(const std::vector<Setting>& all) {
  std::vector<CostCurve> curves;
  Series chosen{.name = "default: rk4, a step a period", .mark = Mark::points, .paper = true};
  for (const Setting& s : all) {
    if (s.steps == kStepCounts.front())
      curves.push_back({fmt::format("{}, {}", name_of(s.scheme), s.delay > 0.0 ? "2 ms late" : "in time")});
    curves.back().cost.push_back(s.cost);
    curves.back().error.push_back(s.error);
    if (is_default(s)) chosen.add(s.cost, s.error);
  }
  Plot plot = cost_beside_error(
      {.id = "work_precision",
       .title = "Error of the critical stiffness against run time",
       .x_label = "CPU time for one second of experiment (s)",
       .y_label = "error of the critical stiffness (%)",
       .caption = "Time steps from a period (left) to a twentieth of it. Crosses: every stiffness seems "
                  "stable. 3 % is what is asked; below 0.05 % the search for the boundary decides."},
      curves, {{"allowed", 3.0}, {"floor: the search", 0.05}});
  plot.series.push_back(std::move(chosen));
  return plot;
}

// Error against run time: time step x integrator.
void add_error_over_time(Bench& bench) {
  const std::vector<Setting> all = timed_settings(bench);
  double error = 0.0, cost = kUnset, cheapest = kUnset;
  for (const Setting& s : all) {
    if (is_default(s)) {
      error = worse(error, s.error);
      if (s.delay == 0.0) cost = s.cost;
    } else if (s.error <= 3.0 && s.delay == 0.0 && !(cheapest < s.cost)) {
      cheapest = s.cost;
    }
  }
  bench.plot(settings_plot(all));
  bench.table(settings_table(all));
  bench.figure("work_precision.error.max", error, "%", at_most(0.1),
               "critical stiffness at the default, rk4, a step a period");
  bench.cost("work_precision.default_over_cheapest.cpu", cost / cheapest, "x",
             "CPU time of the default over the cheapest other setting that is within 3 % without a delay");
}

void run(Bench& bench) {
  add_cost(bench);
  add_linear_cases(bench);
  add_integrators(bench);
  add_regions(bench);
  add_wall_maps(bench);
  add_button_map(bench);
  add_admittance_map(bench);
  add_scenes(bench);
  add_passivity(bench);
  add_spare(bench);
  add_widths(bench);
  add_error_over_time(bench);
}

const Reads kReads{"stability", {.scenes = {"tennis_ball", "session", "training"}}};
const Entry kEntry{"stability", "a slide with a wall",
                   "which walls are stable: eigenvalues, bounds and friction against MuJoCo", run};

}  // namespace

certificate::SampledLoop loop_of(const Device& d) {
  return {d.mass, d.damping, d.period, d.delay, 1, kUnset, {d.hand_mass, d.hand_damping, d.hand_spring}};
}

certificate::Rest same_as(Outcome outcome) {
  return outcome == Outcome::still   ? certificate::Rest::still
         : outcome == Outcome::cycle ? certificate::Rest::cycle
         : outcome == Outcome::away  ? certificate::Rest::away
                                     : certificate::Rest::unknown;
}

void Agreement::see(certificate::Rest told, certificate::Rest seen) {
  const bool known = told != certificate::Rest::unknown && seen != certificate::Rest::unknown;
  places += 1.0;
  rest += known && (told == certificate::Rest::still) == (seen == certificate::Rest::still) ? 1.0 : 0.0;
  same += known && told == seen ? 1.0 : 0.0;
}

Device believed(const BenchContext& context, Device device) {
  if (!context.mutated("ten_times_damped")) return device;
  for (double* one : {&device.damping, &device.hand_damping, &device.friction}) *one *= 10.0;
  return device;
}

double worse(double a, double b) { return std::isnan(a) ? a : std::isnan(b) ? b : std::max(a, b); }
certificate::Steps steps_of(const Device& device) { return {device.friction, device.count}; }

}  // namespace enc::bench::stability
