// Counts contacts per press: many hands, a tracker that is off by 0.3 mm either way, and a push far beyond
// the limit.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/kit/precision.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::press {
namespace {

struct Tally {
  std::int64_t presses = 0, single = 0;
  double outside = -1.0, tension = 0.0, restore = 0.0, simulated = 0.0, over_limit = -trial::kInfinite;
};

Tally press(const models::Setup& setup, std::uint64_t seed) {
  Tally tally;
  const trial::PressMeasure measure = trial::measured_run(setup, seed, tally.simulated);
  for (const trial::PressFigures& press : measure.presses()) {
    ++tally.presses;  // includes a press that never met the surface: it has no contact
    tally.single += press.contacts == 1 ? 1 : 0;
    if (!std::isnan(press.restore_error)) tally.restore = std::max(tally.restore, press.restore_error);
    tally.over_limit = std::max(tally.over_limit, press.over_limit);
  }
  tally.outside = std::max(tally.outside, measure.greatest_outside());
  tally.tension = std::max(tally.tension, measure.greatest_tension());
  return tally;
}

Tally sum(const std::vector<Tally>& each) {
  Tally all;
  for (const Tally& one : each) {
    all.presses += one.presses;
    all.single += one.single;
    all.outside = std::max(all.outside, one.outside);
    all.tension = std::max(all.tension, one.tension);
    all.restore = std::max(all.restore, one.restore);
    all.over_limit = std::max(all.over_limit, one.over_limit);
  }
  return all;
}

// The i-th hand: registration errors of 0.3 mm along the normal, both ways, and along both tangents, on top
// of the tracker's own noise; all of them at one speed, then at the next.
models::Setup varied(models::Setup setup, std::uint64_t i) {
  constexpr double kBias = 0.3e-3;
  constexpr std::array kSpeeds{0.010, 0.020, 0.050, 0.100};  // m/s
  setup.twin.tracker.bias = (i % 2 == 0 ? kBias : -kBias) * Vec3::Unit(static_cast<int>((2 + i / 2) % 3));
  setup.scene.user->approach = {kSpeeds[i / 6 % kSpeeds.size()]};
  return setup;
}

void run(Bench& bench) {
  models::Setup setup = bench.setup();
  UserSpec& user = *setup.scene.user;
  user.press_time = user.release_time = 1.5;
  user.hold_time = 0.2;
  user.depth = 0.004;
  const Tally tally = sum(bench.each(bench.seeds(bench.context.count(200, 20)), [&](std::uint64_t seed) {
    return press(varied(setup, seed - bench.context.seed), seed);
  }));
  bench.figure(
      "one_contact.percent", 100.0 * static_cast<double>(tally.single) / static_cast<double>(tally.presses),
      "%", exactly(100),
      fmt::format("{} presses, tracker off by 0.3 mm along x, y, z, both ways, with noise", tally.presses));
  bench.figure("restore.max", tally.restore * 1e6, "um", between(0, 6),
               "true tip to the buffered point; the machine steps by 3 um, servo still settling");
  bench.figure("outside.max", tally.outside * 1e6, "um", at_most(0),
               "true tip outside the undeformed object; negative: always inside");
  bench.figure("tension.max", tally.tension, "N", "pull on the unbound tool; the twin's contact cannot pull");

  setup = load_scene(bench.context, "push_limit");
  for (const double limit : {0.006, 0.004, 0.002}) {
    setup.scene.objects.front().limit = limit;
    const Tally pushed = sum(bench.each(bench.seeds(bench.context.quick ? 2 : 10),
                                        [&](std::uint64_t seed) { return press(setup, seed); }));
    bench.figure(fmt::format("over_limit.{:.0f}.max", limit * 1e3), pushed.over_limit * 1e6, "um",
                 between(-50, 50), "true deflection above the limit under a push of 30 N");
  }
  add_force_precision(bench, {"user.approach_mm_s=[50]", "user.approach_from_mm=20", "user.press_s=1.5",
                              "user.hold_s=0.2", "user.release_s=1.5", "user.depth_mm=4"});
}

const Reads kReads{"press", {.scenes = {"tennis_ball", "push_limit"}}};
const Entry kEntry{"press", "tennis_ball", "one contact for each press, limit held, tip inside, no pull",
                   run};

}  // namespace
}  // namespace enc::bench::press
