// The paper's machine is told each millisecond, over EtherCAT; over GCS a set-point goes each ten or so. A
// press of the ball, Table 1 and Fig 3 are the same with a cycle of 1 ms as without wires, and a press with
// one of 10 ms, too (docs/guide/laboratory.md).
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/stiffness/push_study.h"
#include "benchmarks/tracking/table1.h"
#include "core/base/units.h"
#include "hw_drivers/wires/tight_times.h"
#include "tests/benchmarks/wires/wired_trial.h"
#include "tests/support/built.h"

namespace enc::bench::wires {
namespace {

struct Cycled {
  Pressed press;
  double rmse_40 = kUnset;  // m, Table 1, x at 40 mm/s
  double felt = kUnset;     // %, Fig 3 at 10 N/mm
};

models::Setup on_fakes(const std::string& scene, int cycle, std::vector<std::string> set) {
  set.push_back(fmt::format("rig.driver.gcs.cycle_ms={}", std::max(cycle, 1)));
  set.push_back(fmt::format("rig.driver.gcs.poll_ms={}", cycle > 1 ? 2 : 1));
  return models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", "fakes",
                      enc::wires::tight_times(std::move(set)));
}

// measure(options, setup) with the devices of the set-up behind their wires; with a cycle of 0 without.
template <class Measure>
auto through(const models::Setup& setup, int cycle, const Measure& measure) {
  if (cycle == 0) return measure(trial::TrialOptions{}, setup);
  Laboratory laboratory(setup);
  return measure(laboratory.behind({}), laboratory.setup());
}

Cycled with_cycle(int cycle) {
  Cycled of;
  of.press = through(on_fakes("tennis_ball", cycle, {}), cycle,
                     [&](trial::TrialOptions options, const models::Setup& with) {
                       options.seed = 1;
                       options.seconds = kOnePress;
                       trial::Trial trial(with, std::move(options));
                       return pressed(trial);
                     });
  EXPECT_FALSE(of.press.held) << cycle;
  const tracking::TravelErrors errors =
      through(on_fakes("tracking", cycle, {"travel.axes=\"x\"", "travel.speed_mm_s=40"}), cycle,
              [&](const trial::TrialOptions& options, const models::Setup& with) {
                return tracking::run_travel(with, 1, false, options);
              });
  EXPECT_EQ(errors.held, "") << cycle;
  of.rmse_40 = errors.forward[0].errors().rmse;
  const models::Setup push =
      on_fakes("stiffness", cycle, {"rig.force.tare=start", "rig.contact.softest_N_per_mm=0"});
  const stiffness::Push felt = through(stiffness::with_stiffness(push, 10.0 * kNewtonPerMillimetre), cycle,
                                       [&](const trial::TrialOptions& options, const models::Setup& with) {
                                         return stiffness::push_once(with, 1, nullptr, options);
                                       });
  EXPECT_EQ(felt.held, "") << cycle;
  of.felt = felt.error(felt.measured);
  return of;
}

TEST(SetPointCycles, OfOneMillisecondAreAsNoWires) {
  std::vector<Cycled> all(3);
  in_parallel(all.size(), [&](std::size_t i) { all[i] = with_cycle(std::vector{0, 1, 10}[i]); });
  const Cycled &pure = all[0], &fast = all[1], &usual = all[2];
  EXPECT_EQ(fast.press.contacts, 1);
  EXPECT_EQ(usual.press.contacts, 1);
  EXPECT_NEAR(fast.press.peak, pure.press.peak, 0.2);  // N
  EXPECT_NEAR(usual.press.peak, pure.press.peak, 0.2);
  EXPECT_NEAR(fast.press.touched, pure.press.touched, 5e-3);  // s, when the first touch is noticed
  // The peak is where the ball's limit is, and would hide a machine that is late or turned.
  double sum = 0.0;
  const std::size_t n = std::min(fast.press.height.size(), pure.press.height.size());
  for (std::size_t i = 0; i < n; ++i) sum += std::pow(fast.press.height[i] - pure.press.height[i], 2);
  EXPECT_LE(std::sqrt(sum / static_cast<double>(n)), 0.05e-3);
  EXPECT_NEAR(fast.rmse_40 / pure.rmse_40, 1.0, 0.05);
  EXPECT_NEAR(fast.felt, pure.felt, 0.5);  // %
}

}  // namespace
}  // namespace enc::bench::wires
