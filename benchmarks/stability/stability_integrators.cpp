// What MuJoCo's integrators do to the boundary of a wall that is sampled [sources/twin 1].
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/stability/stability.h"

namespace enc::bench::stability {
namespace {

struct Stepped {
  Scheme scheme;
  int steps;
  double delay;  // s
};
struct Moved {
  double factor = kUnset, expected = kUnset;  // of the critical stiffness
};

// (T/2 + t_d)/(T/2 + t_d - h/2) of the first-order ones: their place is that of half a step later.
Moved moved_by(const Stepped& s) {
  const Device device{0.1, 0.2, 1e-3, s.delay};
  const double exact = certificate::critical_stiffness(loop_of(device)), lag = 0.5e-3 + s.delay;
  const double gained = s.scheme == Scheme::rk4 ? 0.0 : 0.5e-3 / s.steps;
  const double simulated = critical(device, 0.0, {s.scheme, s.steps}, kUnset, 50.0 * exact);
  return {simulated / exact, lag / std::max(0.0, lag - gained)};
}

}  // namespace

void add_integrators(Bench& bench) {
  std::vector<Stepped> all;
  for (const Scheme scheme : kSchemes)
    for (const int steps : {1, 2, 10})
      for (const double delay : {0.0, 1e-3, 2e-3, 5e-3}) all.push_back({scheme, steps, delay});
  const auto found = bench.each(all, moved_by);
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
                all[i].delay * 1e3, fmt::format("{:.4f}", found[i].factor),
                fmt::format("{:.4f}", found[i].expected));
      const bool none = std::isinf(found[i].factor) && std::isinf(found[i].expected);
      const double off = none ? 0.0 : 100.0 * std::abs(found[i].factor / found[i].expected - 1.0);
      worst = worse(worst, off);
      if (all[i].steps == 10) largest = worse(largest, found[i].factor);
    }
    bench.figure(fmt::format("{}.factor.tenth", name_of(scheme)), largest, "x",
                 "critical stiffness over the exact one, time step T/10, no delay");
    bench.figure(fmt::format("{}.factor_error.max", name_of(scheme)), worst, "%", at_most(3.0),
                 scheme == Scheme::rk4 ? "against 1, time steps T to T/10, delays 0 to 5 ms"
                                       : "against (T/2 + t_d)/(T/2 + t_d - h/2), the same");
  }
  bench.table(std::move(table));
}

}  // namespace enc::bench::stability
