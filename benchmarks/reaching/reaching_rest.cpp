// The far arm rests, whatever its friction is and however it sets in.
#include <algorithm>

#include <fmt/format.h>

#include "benchmarks/reaching/reaching.h"

namespace enc::bench::reaching {
namespace {

// Friction: none; what 0.04 N at the tip are [PHANToM sheet]; the estimate of the published model; twice
// that. Its onset: as sharp as the time step allows, up to the constraint's own 20 ms.
struct Friction {
  double torque_Nm, time_ms, timestep_us;
};
std::vector<Friction> frictions(const BenchContext& context) {
  std::vector<Friction> all;
  for (const double torque : {0.0028, 0.0056, 0.01, 0.02}) {
    for (const double time : {2.0, 6.0, 20.0}) all.push_back({torque, time, 1000.0});
    if (context.full) all.push_back({torque, 0.1, 50.0});
  }
  if (context.quick) return {all[6]};
  all.push_back({0.0, 20.0, 1000.0});
  return all;
}

Settings set_of(const Friction& f) {
  return {fmt::format("truth.arm.friction_Nm=[{0}, {0}, {0}]", f.torque_Nm),
          fmt::format("truth.arm.friction_time_ms={}", f.time_ms),
          fmt::format("truth.arm.timestep_us={}", f.timestep_us)};
}

}  // namespace

void add_rest(const BenchContext& context, BenchResult& result, const Adder& add) {
  const std::vector<Friction> all = frictions(context);
  const int people = context.full ? 8 : 1;
  std::vector<ReachRun> runs;
  for (const Friction& f : all)
    for (int i = 0; i < people; ++i)
      runs.push_back(
          random_reaches("wall", context.full ? 8 : 4, context.seed + static_cast<std::uint64_t>(i)) +
          seen(Seen::vision) + set_of(f));
  const std::vector<ReachRan> ran = run_all(context, runs);
  Table table{"reaching_rest",
              "Speed of the far tip, over the friction of the joints and how it sets in",
              {"friction (N m)", "sets in (ms)", "time step (us)", "reaches", "at most (mm/s)"}};
  double most = 0.0, none = kUnset;
  std::size_t reaches = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto from = ran.begin() + static_cast<std::ptrdiff_t>(i) * people;
    double here = 0.0;
    for (auto one = from; one != from + people; ++one) {
      here = std::max(here, one->far_speed);
      result.simulated += one->simulated;
    }
    const std::size_t met = joined({from, from + people}).size();
    if (all[i].torque_Nm > 0.0) {
      reaches += met;
      most = std::max(most, here);
    } else {
      none = here;
    }
    table.rows.push_back({fmt::format("{:g}", all[i].torque_Nm), fmt::format("{:g}", all[i].time_ms),
                          fmt::format("{:g}", all[i].timestep_us), fmt::format("{}", met),
                          fmt::format("{:.2g}", 1e3 * here)});
  }
  table.note =
      "From a second after the finger went away. Friction that sets in within 2 ms holds from 1 mm/s on.";
  result.tables.push_back(std::move(table));
  add("rest.reaches", static_cast<double>(reaches), "", kUnset, kUnset,
      "random reaches with other frictions than the rig's");
  add("rest.far_speed_mm_s", 1e3 * most, "mm/s", kUnset, 0.1,
      "of the tip, at most, while the finger is far: joints with 0.0028 to 0.02 N m of friction, which sets "
      "in "
      "within 2 to 20 ms (--full: from 0.1 ms on)");
  if (!context.quick)
    add("rest.without_friction_mm_s", 1e3 * none, "mm/s", kUnset, kUnset,
        "the same of joints without any: nothing holds what the law lets go");
}

}  // namespace enc::bench::reaching
