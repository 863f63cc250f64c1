// The twin of Table 1 against the chain's own theory: for random chains, and for each parameter alone.
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/tracking/table1.h"
#include "benchmarks/tracking/tracking_fit.h"
#include "sim/plants/tracker_plant.h"
#include "tests/support/built.h"

namespace enc::bench::tracking {
namespace {

models::Setup setup_with(std::vector<std::string> set) {
  std::vector<std::string> all{"travel.axes=\"x\"", "travel.speed_mm_s=40", "travel.dwell_s=0.5"};
  all.insert(all.end(), set.begin(), set.end());
  return models::load(tests::source_dir() + "/models/scenes/tracking.toml", "sim", all);
}

// Over `seeds` phases of the clocks, forward.
Errors twin_of(const models::Setup& setup, std::uint64_t seeds) {
  TravelErrors sum;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) sum.add(run_travel(setup, seed, false));
  return sum.forward[0].errors();
}
Errors theory_of(const models::Setup& setup) {
  const ToolSpec& tool = setup.scene.tools.front();
  const sim::TrackerTruth truth = sim::with_tool_known(setup.twin.tracker, tool.markers, tool.tip);
  return Lag(likely_ages(chain_of(setup)), moves_of(setup)).errors(truth.bias.x(), truth.noise.x());
}

TEST(TrackingProperty, TwinAndTheoryAgreeForRandomChains) {
  std::mt19937_64 random(4);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
  };
  for (int i = 0; i < 6; ++i) {
    const double acceleration = uniform(0.25, 2.0);
    const models::Setup setup = setup_with(
        {fmt::format("truth.tracker.latency_ms={}", uniform(2, 15)),
         fmt::format("truth.tracker.process_ms={}", uniform(0, 8)),
         fmt::format("truth.tracker.udp_delay_ms={}", uniform(0, 6)),
         fmt::format("truth.tracker.bias_mm=[{}, 0, 0]", uniform(-0.2, 0.2)),
         fmt::format("truth.tracker.noise_mm=[{}, 0, 0]", uniform(0, 0.1)), "truth.tracker.marker_noise_mm=0",
         fmt::format("truth.tracker.rate_hz={}", uniform(90, 200)),
         fmt::format("truth.tracker.server_rate_hz={}", uniform(40, 110)),
         fmt::format("truth.hexapod.acceleration_m_s2={}", acceleration),
         fmt::format("rig.manipulator.acceleration_m_s2={}", acceleration),
         fmt::format("travel.speed_mm_s={}", uniform(10, 45))});
    const Errors twin = twin_of(setup, 10);
    const Errors theory = theory_of(setup);
    EXPECT_NEAR(twin.rmse, theory.rmse, 0.04 * theory.rmse) << i;
    EXPECT_NEAR(twin.mae, theory.mae, 0.04 * theory.mae) << i;
  }
}

// The same seeds before and after: what changes is the parameter alone.
TEST(TrackingProperty, EachParameterMovesTheFiguresAsTheTheorySays) {
  const models::Setup base = setup_with({});
  const Errors before = twin_of(base, 15);
  const Errors before_theory = theory_of(base);
  struct Change {
    const char* name;
    std::vector<std::string> set;
  };
  for (const Change& change :
       {Change{"latency", {"truth.tracker.latency_ms=8.5"}},
        Change{"process", {"truth.tracker.process_ms=4.6"}},
        Change{"udp delay", {"truth.tracker.udp_delay_ms=4"}},
        Change{"bias", {"truth.tracker.bias_mm=[-0.05, 0, 0]"}},
        Change{"noise", {"truth.tracker.noise_mm=[0.25, 0, 0]"}},
        Change{"acceleration",
               {"truth.hexapod.acceleration_m_s2=1.5", "rig.manipulator.acceleration_m_s2=1.5"}},
        Change{"server rate", {"truth.tracker.server_rate_hz=240"}},
        Change{"tracker rate", {"truth.tracker.rate_hz=320"}}}) {
    const models::Setup setup = setup_with(change.set);
    const Errors after = twin_of(setup, 15);
    const Errors after_theory = theory_of(setup);
    const double moved = after.rmse - before.rmse;
    const double expected = after_theory.rmse - before_theory.rmse;
    EXPECT_GT(std::abs(expected), 0.015e-3) << change.name;  // it matters
    EXPECT_NEAR(moved, expected, 0.12 * std::abs(expected) + 0.008e-3) << change.name;
  }
}

// What would be left if nothing of the chain were there is rounding.
TEST(TrackingProperty, WithoutBiasNoiseDelayWaitAndStepTheErrorIsRounding) {
  const models::Setup setup = setup_with(
      {"travel.dwell_s=0.1", "truth.tracker.bias_mm=[0,0,0]", "truth.tracker.noise_mm=[0,0,0]",
       "truth.tracker.marker_noise_mm=0", "truth.tracker.latency_ms=0", "truth.tracker.process_ms=0",
       "truth.tracker.udp_delay_ms=0", "truth.tracker.clocks=\"aligned\"", "truth.tracker.rate_hz=1000",
       "truth.tracker.server_rate_hz=1000", "truth.hexapod.step_um=0", "truth.hexapod.repeatability_um=0"});
  const TravelErrors errors = run_travel(setup, 1, false);
  EXPECT_GT(errors.forward[0].size(), 1000);
  EXPECT_LT(errors.largest, 1e-9);
}

}  // namespace
}  // namespace enc::bench::tracking
