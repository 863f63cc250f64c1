// Which walls are stable: the certificate's exact eigenvalues, bounds and release against a slide in MuJoCo
// that is assembled apart (docs/reference/stability.md).
#include "benchmarks/stability/stability.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

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
  return all;
}

struct Found {
  double predicted = kUnset, formula = kUnset;
  double at[3] = {kUnset, kUnset, kUnset};  // of 1, 2, 10 steps a period; unset: no whole number of them
  double error = 0.0;                       // %, the largest
};
constexpr int kSteps[] = {1, 2, 10};

Found find(const Case& of, bool quick) {
  Found found;
  const certificate::Damper damper{of.damper, 0.0};
  found.predicted = certificate::critical_stiffness(loop_of(of.device), damper);
  found.formula = certificate::delayed_stiffness(loop_of(of.device), damper);
  double near = kUnset;
  for (std::size_t i = 0; i < (quick ? 2U : 3U); ++i) {
    if (kSteps[i] < of.steps) continue;
    near = found.at[i] = critical(of.device, of.damper, {Scheme::rk4, kSteps[i]}, near, kMost);
    const double error = 100.0 * std::abs(found.predicted / near - 1.0);
    found.error = error <= found.error ? found.error : error;  // NaN stays
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
  double within = 0.0, beyond = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Device& d = all[i].device;
    if (d.hand_spring > 0.0) continue;
    const double simulated = *std::find_if(std::begin(found[i].at), std::end(found[i].at),
                                           [](double k) { return !std::isnan(k); });
    double& most = all[i].damper <= d.damping ? within : beyond;
    most = std::max(most, 100.0 * (found[i].formula / simulated - 1.0));
  }
  bench.figure("gil_hulin.within.max", within, "%",
               "by how much (b + B)/(T/2 + delay) is above what MuJoCo does, B up to b");
  bench.figure("gil_hulin.beyond.max", beyond, "%", "the same, B above b: there it is no bound");
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

// What one certificate costs: the law of an arm, filtered, rates of two ticks, 2 ms late, with a hand.
void add_cost(Bench& bench) {
  Device device = held(device_of(0.0114, 2.0, 0.075));
  certificate::SampledLoop loop = loop_of(device);
  loop.ticks = 2;
  loop.filter = 0.377;  // 60 Hz
  std::vector<double> seconds;
  for (int i = 0; i < 15; ++i) {
    const double start = thread_seconds();
    const certificate::Certificate found =
        certificate::certify(loop, {0.048, 28.7e-6}, {300.0 + i, {0.0, 11.5 / 300.0}});
    seconds.push_back(thread_seconds() - start);
    if (found.rows.empty()) throw Error("a certificate without rows");
  }
  bench.figure("certificate.time.median", 1e3 * median(seconds), "ms", "CPU time of one");
}

void run(Bench& bench) {
  add_cost(bench);
  add_linear_cases(bench);
  add_integrators(bench);
  add_regions(bench);
}

const Entry kEntry{"stability", "a slide with a wall",
                   "which walls are stable: eigenvalues, bounds and friction against MuJoCo", run};

}  // namespace

certificate::SampledLoop loop_of(const Device& d) {
  return {d.mass, d.damping, d.period, d.delay, 1, kUnset, {d.hand_mass, d.hand_damping, d.hand_spring}};
}
certificate::Steps steps_of(const Device& device) { return {device.friction, device.count}; }

void add_linear_cases(Bench& bench) {
  const bool quick = bench.context.quick;
  std::vector<Case> all = cases();
  if (quick) std::erase_if(all, [](const Case& of) { return of.steps > 2; });  // no step of T/10 then
  const auto found = bench.each(all, [&](const Case& of) { return find(of, quick); });
  double worst = 0.0;
  for (const Found& f : found) worst = f.error <= worst ? worst : f.error;
  bench.figure(
      "critical.cases.value", static_cast<double>(all.size()), "", at_least(60.0),
      "over b, B, delay, mass, period, hand, each at time step T, T/2 and T/10 where the delay allows");
  bench.figure("critical.error.max", worst, "%", at_most(3.0),
               "critical stiffness: exact eigenvalues against MuJoCo");
  add_formula(bench, all, found);
  add_no_stiffness(bench);
  add_table(bench, all, found);
}

}  // namespace enc::bench::stability
