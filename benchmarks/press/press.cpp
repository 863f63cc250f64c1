// Does every press stay one press? Many hands, a tracker that is off by 0.3 mm either way, and a push far
// beyond the limit.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/parallel.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::press {
namespace {

struct Tally {
  std::int64_t presses = 0, single = 0;
  double outside = -1.0, tension = 0.0, restore = 0.0, simulated = 0.0, over_limit = -trial::kInfinite;
};

void press_once(const models::Setup& setup, std::uint64_t seed, Tally& tally) {
  const trial::PressMeasure measure = trial::measured_run(setup, seed, tally.simulated);
  for (const trial::PressFigures& press : measure.presses()) {
    ++tally.presses;  // also one that never met the surface: it then has no contact
    tally.single += press.contacts == 1 ? 1 : 0;
    if (!std::isnan(press.restore_error)) tally.restore = std::max(tally.restore, press.restore_error);
    tally.over_limit = std::max(tally.over_limit, press.over_limit);
  }
  tally.outside = std::max(tally.outside, measure.greatest_outside());
  tally.tension = std::max(tally.tension, measure.greatest_tension());
}

// The tallies of `count` runs on all cores, in their order.
Tally press_all(std::size_t count, const std::function<void(std::size_t, Tally&)>& press,
                const std::function<void(double)>& progress = {}) {
  std::vector<Tally> each(count);
  in_parallel(
      count, [&](std::size_t i) { press(i, each[i]); }, progress);
  Tally all;
  for (const Tally& one : each) {
    all.presses += one.presses;
    all.single += one.single;
    all.simulated += one.simulated;
    all.outside = std::max(all.outside, one.outside);
    all.tension = std::max(all.tension, one.tension);
    all.restore = std::max(all.restore, one.restore);
    all.over_limit = std::max(all.over_limit, one.over_limit);
  }
  return all;
}

// Registration errors of 0.3 mm along the normal, both ways, and along both tangents, on top of the tracker's
// own noise.
Vec3 bias_of(std::int64_t i) {
  constexpr double kBias = 0.3e-3;
  const double sign = i % 2 == 0 ? kBias : -kBias;
  return sign * Vec3::Unit(static_cast<int>((2 + i / 2) % 3));
}

}  // namespace

BenchResult run(const BenchContext& context) {
  BenchResult result{"press", "tennis_ball", 0, 0, {}};
  models::Setup setup = load_scene(context, "tennis_ball");
  const std::int64_t repeats = context.repeats > 0 ? context.repeats : (context.quick ? 20 : 200);
  UserSpec& user = *setup.scene.user;
  user.press_time = user.release_time = 1.5;
  user.hold_time = 0.2;
  user.depth = 0.004;
  const Tally tally = press_all(
      static_cast<std::size_t>(repeats),
      [&](std::size_t i, Tally& one) {
        models::Setup own = setup;
        own.twin.tracker.bias = bias_of(static_cast<std::int64_t>(i));
        own.scene.user->approach = {std::array{0.010, 0.020, 0.050, 0.100}[i / 6 % 4]};
        press_once(own, context.seed + i, one);
      },
      context.progress);
  const auto add = [&](std::string id, double twin, const char* unit, double low, double high,
                       std::string note) {
    result.figures.push_back({std::move(id), kUnset, twin, unit, Role::ours, low, high, std::move(note)});
  };
  add("press.one_contact.percent",
      100.0 * static_cast<double>(tally.single) / static_cast<double>(tally.presses), "%", 100, 100,
      fmt::format("{} presses, tracker off by 0.3 mm along x, y, z, both ways, with noise", tally.presses));
  add("press.restore.max", tally.restore * 1e6, "um", 0, 6,
      "true tip to the buffered point; the machine steps by 3 um, servo still settling");
  add("press.outside.max", tally.outside * 1e6, "um", kUnset, 0,
      "true tip outside the undeformed object; negative: always inside");
  add("press.tension.max", tally.tension, "N", 0, 0.05, "pull on the unbound tool");
  result.simulated = tally.simulated;

  setup = load_scene(context, "push_limit");
  for (const double limit : {0.006, 0.004, 0.002}) {
    setup.scene.objects.front().limit = limit;
    const Tally pushed = press_all(context.quick ? 2U : 10U, [&](std::size_t i, Tally& one) {
      press_once(setup, context.seed + i, one);
    });
    add(fmt::format("press.over_limit.{:.0f}.max", limit * 1e3), pushed.over_limit * 1e6, "um", -50, 50,
        "true deflection above the limit under a push of 30 N");
    result.simulated += pushed.simulated;
  }
  return result;
}

}  // namespace enc::bench::press
