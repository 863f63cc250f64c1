// Which walls are stable: the certificate's exact eigenvalues, bounds and release against a slide in MuJoCo
// that is assembled apart (docs/reference/stability.md).
#include "benchmarks/stability/stability.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/kit/yardstick.h"
#include "benchmarks/stability/maps.h"
#include "core/base/error.h"

namespace enc::bench::stability {
namespace {

constexpr double kMost = 1e6;  // N/m, from which down is looked

struct Case {
  Device device;
  double damper = 0.0;
  int steps = 1;  // the fewest that its delay allows
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
  // As much damping in the wall as in the device, up to a damper that stops it within the delay.
  for (const auto& [mass, damping] : {std::pair{0.1, 0.2}, {0.1, 1.0}, {0.1, 5.0}})
    for (const double delay : {0.0, 1.0, 3.0, 10.0})
      all.push_back({device_of(damping, delay, mass), damping});
  return all;
}

struct Found {
  double predicted = kUnset, formula = kUnset;
  double at[3] = {kUnset, kUnset, kUnset};  // of 1, 2, 10 steps a period; unset: no whole number of them
  double error = 0.0;                       // %, the largest
  int judged = 0;                           // of those steps
  bool applies = false;                     // the formula, by the certificate
};
constexpr int kSteps[] = {1, 2, 10};

Found find(const Case& of, bool quick) {
  Found found;
  const certificate::Damper damper{of.damper, 0.0};
  found.predicted = certificate::critical_stiffness(loop_of(of.device), damper);
  for (const certificate::Row& row : certificate::bounds(loop_of(of.device), {0.0, 0.0}, {1.0, damper}))
    if (row.name == "gil_hulin") {
      found.formula = row.bound;
      found.applies = row.applies;
    }
  double near = kUnset;
  for (std::size_t i = 0; i < (quick ? 2U : 3U); ++i) {
    if (kSteps[i] < of.steps) continue;
    near = found.at[i] = critical(of.device, of.damper, {Scheme::rk4, kSteps[i]}, near, kMost);
    const double error = 100.0 * std::abs(found.predicted / near - 1.0);
    found.error = worse(found.error, error);
    ++found.judged;
  }
  return found;
}

void add_table(Bench& bench, const std::vector<Case>& all, const std::vector<Found>& found) {
  Table table{"critical",
              "Critical stiffness: eigenvalues, MuJoCo, Gil and Hulin's formula",
              {"mass (kg)", "b (N s/m)", "B (N s/m)", "T (ms)", "delay (ms)", "hand", "eigenvalues (N/m)",
               "step T (N/m)", "T/2 (N/m)", "T/10 (N/m)", "formula (N/m)", "largest error (%)"}};
  const auto number = [](double x) { return std::isnan(x) ? std::string("-") : fmt::format("{:.5g}", x); };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Device& d = all[i].device;
    const Found& f = found[i];
    table.add(d.mass, d.damping, all[i].damper, d.period * 1e3, d.delay * 1e3,
              d.hand_spring > 0.0 ? "yes" : "no", number(f.predicted), number(f.at[0]), number(f.at[1]),
              number(f.at[2]), number(f.formula), fmt::format("{:.3f}", f.error));
  }
  table.note = "Hand: 0.1 kg, 4 N s/m, 300 N/m. Step: MuJoCo's, RK4. Formula: (b + B)/(T/2 + delay).";
  bench.table(std::move(table));
}

// The formula against what was found, where its own condition holds and where it does not.
void add_formula(Bench& bench, const std::vector<Case>& all, const std::vector<Found>& found) {
  double within = 0.0, late = 0.0, beyond = 0.0;
  int applied = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Device& d = all[i].device;
    if (d.hand_spring > 0.0) continue;
    double simulated = kUnset;  // at the coarsest step that there is
    for (const double k : found[i].at)
      if (std::isnan(simulated)) simulated = k;
    double& most = found[i].applies ? within : all[i].damper <= d.damping ? late : beyond;
    most = worse(most, 100.0 * (found[i].formula / simulated - 1.0));
    applied += found[i].applies ? 1 : 0;
  }
  bench.figure("gil_hulin.cases.value", applied, "", at_least(40.0), "of the cases, that it applies to");
  bench.figure("gil_hulin.within.max", within, "%", at_most(5.0),
               "by how much (b + B)/(T/2 + delay) is above what MuJoCo does, where it applies: B up to b, "
               "b (2 T + delay) up to 0.1 m");
  bench.figure("gil_hulin.late.max", late, "%", "the same, B up to b, longer delays: there it is no bound");
  bench.figure("gil_hulin.beyond.max", beyond, "%", "the same, B above b: neither");
}

void add_no_stiffness(Bench& bench) {
  std::vector<double> all;
  for (int i = 0; i <= 32; ++i) all.push_back(1e-2 * std::pow(10.0, 0.25 * i));
  const auto grown = bench.each(all, [](double stiffness) {
    return growth(device_of(0.2, 10.0), {stiffness, 20.0}, {Scheme::rk4, 1});
  });
  bench.figure(
      "damper20.unstable.percent",
      100.0 *
          static_cast<double>(std::count_if(grown.begin(), grown.end(), [](double g) { return g > 0.0; })) /
          static_cast<double>(grown.size()),
      "%", exactly(100.0), "of 33 stiffnesses from 0.01 to 1e6 N/m, 20 N s/m at 10 ms");
  bench.figure("damper20.predicted.value",
               certificate::critical_stiffness(loop_of(device_of(0.2, 10.0)), {20.0, 0.0}), "N/m",
               exactly(0.0), "critical stiffness by the eigenvalues: none is stable");
}

// What a certificate costs: the law of an arm, filtered, rates of two ticks, with a hand.
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
             "the same over a fixed piece of work of the same run (kit/yardstick.h)");
  bench.cost("certificate.fine.time.median", 1e3 * fine, "ms",
             "the same, 10 kHz and 10 ms: 100 periods late");
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

double worse(double a, double b) { return std::isnan(a) ? a : std::isnan(b) ? b : std::max(a, b); }
certificate::Steps steps_of(const Device& device) { return {device.friction, device.count}; }

void add_linear_cases(Bench& bench) {
  const bool quick = bench.context.quick;
  std::vector<Case> all = cases();
  if (quick) std::erase_if(all, [](const Case& of) { return of.steps > 2; });  // no step of T/10 then
  const auto found = bench.each(all, [&](const Case& of) { return find(of, quick); });
  double worst = 0.0, judged = 0.0;
  for (const Found& f : found) {
    worst = worse(worst, f.error);
    judged += f.judged > 0 && std::isfinite(f.error) ? 1.0 : 0.0;
  }
  bench.figure("critical.cases.value", judged, "", at_least(60.0),
               "that have a critical stiffness on both sides, over b, B, delay, mass, period, hand, each at "
               "time step T, T/2 and T/10 where the delay allows");
  bench.figure("critical.error.max", worst, "%", at_most(3.0),
               "critical stiffness: exact eigenvalues against MuJoCo");
  add_formula(bench, all, found);
  add_no_stiffness(bench);
  add_table(bench, all, found);
}

}  // namespace enc::bench::stability
