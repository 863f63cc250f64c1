// Your own benchmark: how far the haptic-tip is from the tool at first touch, over approach speed.
// Run it with `encounter bench touch` (docs/guide/benchmark.md).
#include <array>

#include "benchmarks/kit/kit.h"
#include "core/base/units.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::touch {
namespace {

constexpr std::array<double, 2> kSpeeds{20.0, 100.0};  // mm/s

struct Touch {
  double miss = kUnset;    // m
  double simulated = 0.0;  // s; the report adds these up
};

void run(Bench& bench) {
  const models::Setup setup = bench.setup({"user.hold_s=0.1"});
  const auto touch = [&](double speed, std::uint64_t seed) {
    models::Setup own = setup;
    own.scene.user->approach = {speed / kMmPerM};
    Touch cell;
    cell.miss = trial::measured_run(own, seed, cell.simulated).presses().front().miss;
    return cell;
  };
  const auto touches = bench.grid(kSpeeds, bench.context.count(40, 5), touch);  // [speed][seed]
  for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
    const Value miss = median_of(known(touches[i], &Touch::miss)) * kMmPerM;
    bench.figure(fmt::format("miss.{}.median", kSpeeds[i]), miss, "mm", at_most(2.0), "over seeds");
  }
}

const Entry kEntry{"touch", "tennis_ball", "tip to tool at first touch, over approach speed", run};

}  // namespace
}  // namespace enc::bench::touch
